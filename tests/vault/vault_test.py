#!/usr/bin/env python3
"""`prismesh vault` as it is used, against OpenStack Swift's S3 API where it is installed, over a line that fails as it is told.

    vault_test.py PROGRAMS
"""
import hashlib
import json
import os
import pathlib
import random
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

from faulty_line import FaultyLine
from s3_client import S3Client
from swift_store import ACCESS_KEY, REGION, SECRET_KEY, SwiftStore, missing

PROGRAMS = pathlib.Path()
BUCKET = "models"
PIECE = 4 << 20


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def noise(size, seed):
    """Comments of a deck that no packing shortens, with a line for each 80 bytes."""
    dice = random.Random(seed)
    line = 80
    return b"".join(b"$" + dice.randbytes(39).hex().encode() + b"\n" for _ in range(size // line))


class Vault(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if why := missing():
            raise unittest.SkipTest("SWIFT IS NOT TESTED: " + why)
        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.store = SwiftStore(pathlib.Path(cls.place.name) / "swift")
        cls.enterClassContext(cls.store)
        cls.client = S3Client(cls.store.port, ACCESS_KEY, SECRET_KEY, REGION)
        cls.client.make_bucket(BUCKET)
        cls.line = FaultyLine(cls.store.port)
        cls.addClassCleanup(cls.line.close)
        cls.source = pathlib.Path(cls.place.name) / "crash"
        (cls.source / "parts").mkdir(parents=True)
        subprocess.run([PROGRAMS / "prismesh", "sample", "--elements", "2000", "-o", cls.source / "parts" / "sheets.k"], check=True, capture_output=True)
        (cls.source / "parts" / "notes.k").write_bytes(b"*KEYWORD\n" + noise(2 * PIECE + 100_000, 1) + b"*END\n")
        (cls.source / "main.k").write_text("*KEYWORD\n*INCLUDE\nparts/sheets.k\n*INCLUDE\nparts/notes.k\n*END\n")
        cls.files = contents(cls.source)
        cls.pieces = {sha256(data[at : at + PIECE]) for data in cls.files.values() for at in range(0, len(data), PIECE)}
        manifest = "prismesh-set 1\nmain main.k\n" + "".join(f"{sha256(data)} {len(data)} {path}\n" for path, data in sorted(cls.files.items()))
        cls.model = sha256(manifest.encode())

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.within = self.id().rsplit(".", 1)[-1]  # each test has a vault of its own
        self.line.begin()

    def environment(self):
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("AWS_", "PRISMESH_VAULT", "XDG_CONFIG"))}
        return {**kept, "HOME": str(self.folder), "AWS_ACCESS_KEY_ID": ACCESS_KEY, "AWS_SECRET_ACCESS_KEY": SECRET_KEY, "AWS_REGION": REGION,
                "PRISMESH_VAULT": f"s3+http://127.0.0.1:{self.line.port}/{BUCKET}/{self.within}"}

    def command(self, action, *arguments):
        return [PROGRAMS / "prismesh", "vault", action, *map(str, arguments), "--json"]

    def vault(self, action, *arguments, patience=20):
        done = subprocess.run(self.command(action, *arguments, "--patience", patience), capture_output=True, text=True, env=self.environment(), cwd=self.folder)
        self.assertNotIn(SECRET_KEY, done.stdout + done.stderr)
        return done

    def done(self, action, *arguments, **more):
        done = self.vault(action, *arguments, **more)
        self.assertEqual(done.returncode, 0, f"{done.stderr}{self.line.requests}\n{self.store.logs()}")
        self.assertEqual(done.stderr, "")
        return json.loads(done.stdout)

    def refused(self, words, action, *arguments, **more):
        done = self.vault(action, *arguments, **more)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn(words, done.stderr)
        self.assertEqual(done.stdout, "")

    def push(self, **more):
        return self.done("push", self.source / "main.k", "--name", "front crash, run 7", **more)

    def objects(self, kind=""):
        return self.client.keys(BUCKET, f"{self.within}/{kind}")

    def assert_whole(self):
        """All that the model needs is there with the bytes that its names say, by a client that knows nothing of the program's."""
        self.assertEqual(self.objects("pieces/"), sorted(f"{self.within}/pieces/{piece}" for piece in self.pieces))
        for key in self.objects("pieces/") + self.objects("models/"):
            self.assertEqual(sha256(self.client.get(BUCKET, key)), key.rsplit("/", 1)[-1])
        self.assertEqual(self.objects("models/"), [f"{self.within}/models/{self.model}"])

    def assert_fetched(self, folder, **more):
        got = self.done("fetch", self.model[:12], "-o", folder, **more)
        self.assertEqual(contents(self.folder / folder), self.files)
        self.assertFalse((self.folder / (folder + ".fetching")).exists())
        return got

    def test_there_and_back(self):
        pushed = self.push()
        self.assertEqual((pushed["model"], pushed["files"], pushed["bytes"]), (self.model, 3, sum(map(len, self.files.values()))))
        self.assertEqual((pushed["pieces"], pushed["sent_pieces"], pushed["was_there"]), (len(self.pieces), len(self.pieces), False))
        puts = [request.path for request in self.line.requests if request.method == "PUT"]
        self.assertEqual(puts[-1], f"/{BUCKET}/{self.within}/models/{self.model}", "the manifest is last")
        self.assert_whole()
        listed = self.done("list")["models"]
        self.assertEqual([(each["model"], each["name"], each["bytes"], each["files"]) for each in listed], [(self.model, "front crash, run 7", pushed["bytes"], 3)])
        got = self.assert_fetched("back")
        self.assertEqual((self.folder / "back" / "main.k").as_posix(), (self.folder / got["main"]).as_posix())
        self.assertEqual(self.done("fetch", "front crash, run 7", "-o", "by-name")["model"], self.model)
        self.refused("is there already", "fetch", self.model, "-o", "back")
        verified = self.done("verify")
        self.assertEqual((verified["models"], verified["faults"]), (1, []))
        self.assertEqual(verified["objects"], 2 + len(self.pieces))
        # again: nothing is sent. A variant: only what differs
        self.line.begin()
        self.assertTrue(self.push()["was_there"])
        self.assertEqual(self.line.count("PUT"), 0)
        variant = self.folder / "variant"
        for path, data in self.files.items():
            (variant / path).parent.mkdir(parents=True, exist_ok=True)
            (variant / path).write_bytes(data if path != "main.k" else b"$ another\n" + data)
        self.line.begin()
        self.assertEqual(self.done("push", variant / "main.k")["sent_pieces"], 1)
        self.assertEqual(self.line.count("PUT", "/pieces/"), 1)
        self.assertEqual({each["name"] for each in self.done("list")["models"]}, {"front crash, run 7", "main.k"})
        self.refused("has no model 'nothing'", "fetch", "nothing")


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
