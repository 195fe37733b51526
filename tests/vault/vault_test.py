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
        (cls.source / "parts" / "notes.k").write_bytes(b"*KEYWORD\n" + noise(PIECE + 100_000, 1) + b"*END\n")
        (cls.source / "main.k").write_text("*KEYWORD\n*INCLUDE\nparts/sheets.k\n*INCLUDE\nparts/notes.k\n*END\n")
        cls.files = contents(cls.source)
        cls.large = f"/pieces/{sha256(cls.files['parts/notes.k'][:PIECE])}"
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
        self.line.begin(lambda request: ("answer", 403) if "prefix=" in request.target else None)
        self.assertEqual(self.done("fetch", self.model, "-o", "unlisted")["files"], 3, "a whole hash needs no list")
        self.line.begin()
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


    # --- lines that fail ---

    def once(self, plan):
        """A rule: each fault befalls the first request that it is for. plan: [(method, part of the path, fault)]."""
        left = list(plan)

        def rule(request):
            for each in left:
                if each[0] == request.method and each[1] in request.path:
                    left.remove(each)
                    return each[2]
            return None

        self.addCleanup(lambda: self.assertEqual(left, [], "faults that were never met"))
        return rule

    def test_a_push_over_a_failing_line(self):
        pieces = "/pieces/"
        self.line.begin(self.once([
            ("HEAD", pieces, ("answer", 500)), ("HEAD", pieces, ("lose answer",)), ("HEAD", "/models/", ("answer", 503)),
            ("PUT", self.large, ("answer", 503)), ("PUT", self.large, ("cut request", 1_000_000)), ("PUT", self.large, ("flip request", 77)),
            ("PUT", self.large, ("lose answer",)), ("PUT", "/lists/", ("cut request", 10)), ("GET", "", ("cut answer", 40)),
            ("PUT", "/names/", ("answer", 503)), ("PUT", "/models/", ("flip request", 30)), ("PUT", "/models/", ("lose answer",)),
        ]))
        self.assertEqual(self.push()["sent_pieces"], len(self.pieces))
        self.assert_whole()

    def test_a_fetch_over_a_failing_line(self):
        self.push()
        self.line.begin(self.once([
            ("GET", f"/{BUCKET}", ("answer", 503)), ("GET", "/models/", ("flip answer", 100)), ("GET", "/models/", ("cut answer", 50)),
            ("GET", "/lists/", ("cut answer", 100)), ("GET", self.large, ("cut answer", 700)), ("GET", self.large, ("answer", 500)),
            ("GET", self.large, ("cut answer", 2_000_000)), ("GET", self.large, ("lose answer",)), ("GET", self.large, ("cut answer", 0)),
            ("GET", self.large, ("flip answer", 5)),
        ]))
        self.assert_fetched("back")
        ranges = [request.range for request in self.line.requests if self.large in request.path]
        self.assertEqual(ranges, [None, "bytes=700-", "bytes=700-", *["bytes=2000700-"] * 3, None], "what came before a cut isn't asked for again, but for wrong bytes")

    def test_a_line_that_falls_silent(self):
        self.line.begin(self.once([("PUT", "/pieces/", ("stall request",)), ("HEAD", "/pieces/", ("stall request",))]))
        self.push(patience=4)
        self.assert_whole()
        self.line.begin(self.once([("GET", "/pieces/", ("stall answer", 500))]))
        self.assert_fetched("back", patience=4)
        self.line.begin(lambda request: ("stall request",))
        self.refused("it doesn't answer", "list", patience=1)

    def test_a_push_that_is_refused_at_each_request(self):
        sent = 0
        for number in range(1, 100):
            self.line.begin(lambda request, number=number: ("answer", 403) if len(self.line.requests) + 1 == number else None)
            done = self.vault("push", self.source / "main.k")
            sent += self.line.count("PUT", "/pieces/")
            if done.returncode == 0:
                break
            self.assertIn("refuses these keys", done.stderr)
            self.assertEqual(self.objects("models/"), [])
        self.assertGreater(number, 8)
        self.assertEqual(sent, len(self.pieces), "each piece was sent once, over all tries")
        self.assert_whole()
        got = 0
        for number in range(1, 100):
            self.line.begin(lambda request, number=number: ("answer", 403) if len(self.line.requests) + 1 == number else None)
            done = self.vault("fetch", self.model[:12], "-o", "back")
            got += self.line.count("GET", "/pieces/")
            if done.returncode == 0:
                break
            self.assertFalse((self.folder / "back").exists())
        self.assertGreater(number, 6)
        self.assertEqual(got, len(self.pieces), "each piece came once, over all tries")
        self.assertEqual(contents(self.folder / "back"), self.files)

    def test_a_killed_push_and_a_cancelled_fetch(self):
        puts = []

        def rule(request):
            if request.method == "PUT":
                puts.append(request)
            return ("stall request",) if len(puts) == 3 else None

        self.line.begin(rule)
        runner = subprocess.Popen(self.command("push", self.source / "main.k"), env=self.environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.until(lambda: len(puts) == 3)
        runner.send_signal(signal.SIGKILL)
        self.assertEqual(runner.wait(), -signal.SIGKILL)
        self.line.begin()
        self.assertEqual(self.done("list")["models"], [])
        self.refused("has no model", "fetch", self.model)
        self.assertEqual(len(self.objects("pieces/")), 2)
        self.line.begin()
        self.assertEqual(self.done("push", self.source / "main.k")["sent_pieces"], len(self.pieces) - 2)
        self.assertEqual(self.line.count("PUT", "/pieces/"), len(self.pieces) - 2)
        self.assert_whole()
        self.line.begin(lambda request: ("stall answer", 1000) if "/pieces/" in request.path else None)
        runner = subprocess.Popen(self.command("fetch", self.model, "-o", "back"), env=self.environment(), cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.until(lambda: any("/pieces/" in request.path for request in self.line.requests))
        runner.send_signal(signal.SIGINT)
        self.assertIn("cancelled", runner.communicate()[1])
        self.assertEqual(runner.returncode, 1)
        self.assertFalse((self.folder / "back").exists())
        self.line.begin()
        self.assert_fetched("back")

    def until(self, condition):
        end = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), end, self.line.requests)
            time.sleep(0.01)

    def test_flipped_bytes_are_refused(self):
        self.push()
        large = self.files["parts/notes.k"]
        second = sha256(large[PIECE : 2 * PIECE])
        for part, place, words in ((f"/pieces/{second}", 40, f"gives other bytes for pieces/{second} than its name says"), (f"/models/{self.model}", 40, "gives other bytes for models/"),
                                   ("/lists/", 5, "push the model again with --resend")):
            self.line.begin(lambda request, part=part, place=place: ("flip answer", place) if part in request.path else None)
            self.refused(words, "fetch", self.model, "-o", "back")
            self.assertFalse((self.folder / "back").exists())
        begun = [path for path in (self.folder / "back.fetching" / "sha256").rglob("*") if path.is_file() and path.name == sha256(large)]
        self.assertEqual([path.read_bytes() for path in begun], [large[:PIECE]], "only what matched was kept")
        # somebody changes what lies there
        begun[0].write_bytes(b"x" * 100 + large[100:PIECE])
        self.line.begin()
        self.assert_fetched("back")
        self.assertEqual(self.line.count("GET", f"/pieces/{sha256(large[:PIECE])}"), 1)

    def test_flipped_bytes_are_not_stored(self):
        self.line.begin(lambda request: ("flip request", 9) if request.method == "PUT" else None)
        self.refused("the line changes them", "push", self.source / "main.k")
        self.assertEqual(self.objects(), [])

    def test_files_outside_the_folder(self):
        (self.folder / "deck").mkdir()
        (self.folder / "private.k").write_bytes(b"*KEYWORD\n$ private\n*END\n")
        deck = self.folder / "deck" / "main.k"
        deck.write_text("*KEYWORD\n*INCLUDE\n../private.k\n*END\n")
        self.refused("includes files outside its folder: ", "push", deck)
        (self.folder / "deck" / "link.k").symlink_to("../private.k")
        deck.write_text("*KEYWORD\n*INCLUDE\nlink.k\n*END\n")
        self.refused("link.k; nothing was sent. Send them too with --outside", "push", deck)
        self.assertEqual((self.line.requests, self.objects()), ([], []))
        self.assertEqual(self.done("push", deck, "--outside")["files"], 2)
        deck.write_text("*KEYWORD\n*INCLUDE\n../private.k\n*END\n")
        self.assertEqual(self.done("push", deck, "--outside")["files"], 2)

    # --- stores that fail ---

    def test_damage_on_the_store_s_disk(self):
        self.push()
        victim = sha256(self.files["parts/sheets.k"])
        files = [path for path in (self.store.folder / "devices").rglob("*.data") if path.read_bytes() == self.files["parts/sheets.k"]]
        mine = [path for path in files if f"{self.within}/".encode() in os.getxattr(path, "user.swift.metadata")]
        self.assertEqual(len(mine), 1)
        damaged = bytearray(mine[0].read_bytes())
        damaged[1000] ^= 4
        mine[0].write_bytes(damaged)
        done = self.vault("verify")
        self.assertEqual(done.returncode, 1)
        self.assertEqual([(fault["model"], fault["file"], fault["object"]) for fault in json.loads(done.stdout)["faults"]], [(self.model, "parts/sheets.k", f"pieces/{victim}")])
        self.assertIn(f"parts/sheets.k: pieces/{victim} has other bytes than its name says; push the deck again with --resend", done.stderr)
        done = self.vault("fetch", self.model, "-o", "back")
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"pieces/{victim}", done.stderr)
        self.assertFalse((self.folder / "back").exists())
        self.assertEqual(self.done("push", self.source / "main.k", "--resend")["sent_pieces"], len(self.pieces))
        self.assertEqual(self.done("verify")["faults"], [])
        self.client.delete(BUCKET, f"{self.within}/pieces/{victim}")
        self.client.put(BUCKET, f"{self.within}/pieces/{sorted(self.pieces - {victim})[0]}", b"short")
        done = self.vault("verify", self.model[:10])
        self.assertEqual(sorted(fault["fault"] for fault in json.loads(done.stdout)["faults"]), ["has other bytes than its name says", "isn't there"])
        self.assertEqual(done.returncode, 1)
        self.assertEqual(self.vault("fetch", self.model, "-o", "back").returncode, 1)
        self.assertFalse((self.folder / "back").exists())
        self.assertEqual(self.push()["sent_pieces"], 2, "what is missing or has another size is sent again")
        self.assert_whole()

    def test_encryption(self):
        certificate, key = self.folder / "certificate.pem", self.folder / "key.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=localhost",
                        "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", certificate], check=True, capture_output=True)
        line = FaultyLine(self.store.port, (certificate, key))
        self.addCleanup(line.close)
        environment = {**self.environment(), "PRISMESH_VAULT": f"s3+https://127.0.0.1:{line.port}/{BUCKET}/{self.within}"}

        def told(**more):
            return subprocess.run(self.command("push", self.source / "main.k"), capture_output=True, text=True, env={**environment, **more})

        done = told()
        self.assertEqual((done.returncode, line.requests), (1, []))
        self.assertIn("no authority that this computer trusts vouches for it; nothing was sent", done.stderr)
        self.assertEqual(told(AWS_CA_BUNDLE=str(self.folder / "nothing.pem")).returncode, 1)
        self.assertEqual(line.requests, [])
        done = told(AWS_CA_BUNDLE=str(certificate))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_whole()
        done = told(AWS_CA_BUNDLE=str(certificate), PRISMESH_VAULT=environment["PRISMESH_VAULT"].replace("127.0.0.1", "localhost"))
        self.assertEqual(done.returncode, 1, "the certificate is that of another name")

    def test_what_strangers_put_into_the_bucket(self):
        data = b"*KEYWORD\n*END\n"
        self.client.put(BUCKET, f"{self.within}/pieces/{sha256(data)}", data)
        for path in ("../evil.k", "/tmp/evil.k", "a/../../evil.k", "a//evil.k", "evil.k\\x"):
            text = f"prismesh-set 1\nmain {path}\n{sha256(data)} {len(data)} {path}\n".encode()
            self.client.put(BUCKET, f"{self.within}/models/{sha256(text)}", text)
            self.refused("gives a list of files that isn't taken, line 3: the path ", "fetch", sha256(text), "-o", "back")
        self.assertEqual([path.name for path in self.folder.iterdir()], [])
        text = f"prismesh-set 1\nmain a\n{sha256(data)} {len(data)} a\n".encode()
        self.client.put(BUCKET, f"{self.within}/models/{'0' * 64}", text)
        self.refused("gives other bytes for models/0000", "fetch", "0" * 64)
        self.client.put(BUCKET, f"{self.within}/names/{'0' * 64}/1-2-3-{'1b5b324a'}", b"")
        self.client.put(BUCKET, f"{self.within}/models/readme", b"")
        listed = self.done("list")["models"]
        self.assertEqual(len(listed), 6)
        self.assertEqual({each["name"] for each in listed}, {""})
        done = self.vault("verify")
        self.assertEqual((done.returncode, len(json.loads(done.stdout)["faults"])), (1, 6))

    def test_keys_and_addresses(self):
        program, deck = PROGRAMS / "prismesh", self.source / "main.k"

        def told(*arguments, **changed):
            environment = {key: value for key, value in {**self.environment(), **changed}.items() if value is not None}
            done = subprocess.run([program, "vault", *map(str, arguments)], capture_output=True, text=True, env=environment)
            self.assertNotIn(SECRET_KEY, done.stdout + done.stderr)
            return done.returncode, done.stderr

        def is_told(words, *arguments, **changed):
            status, err = told(*arguments, **changed)
            self.assertEqual(status, 1)
            self.assertIn(words, err)

        url = self.environment()["PRISMESH_VAULT"]
        no_keys = {"AWS_ACCESS_KEY_ID": None, "AWS_SECRET_ACCESS_KEY": None}
        is_told("refuses these keys", "list", AWS_SECRET_ACCESS_KEY="wrong")
        is_told("AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY", "list", **no_keys)
        is_told("there is no bucket 'nothing'", "list", "--vault", url.replace(BUCKET, "nothing"))
        is_told("there is no bucket 'nothing'", "push", deck, "--vault", url.replace(BUCKET, "nothing"))
        is_told("no vault is named", "list", PRISMESH_VAULT=None)
        is_told("is no vault; write s3+https://HOST/BUCKET", "list", "--vault", "https://127.0.0.1/models")
        is_told("has no credentials in it", "list", "--vault", f"s3+http://me:{SECRET_KEY}@127.0.0.1/models")
        is_told("isn't encrypted", "list", "--vault", "s3+http://192.0.2.1/models", "--patience", "1")
        is_told("s3+https://127.0.0.1", "list", "--vault", url.replace("http:", "https:"), "--patience", "1")
        keys = self.folder / "keys.toml"
        keys.write_text(f'vault = "{url}"\naccess_key_id = "{ACCESS_KEY}"\nsecret_access_key = "{SECRET_KEY}"\n')
        keys.chmod(0o640)
        is_told("others may read the keys in it", "list", "--credentials", keys, PRISMESH_VAULT=None, **no_keys)
        keys.chmod(0o600)
        self.assertEqual(told("list", "--credentials", keys, PRISMESH_VAULT=None, **no_keys), (0, ""))
        usual = self.folder / ".config" / "prismesh" / "vault.toml"
        usual.parent.mkdir(parents=True)
        keys.rename(usual)
        self.assertEqual(told("list", PRISMESH_VAULT=None, **no_keys), (0, ""))
        usual.write_text(f'region = "us-east-1"\nsecret_acces_key = "{SECRET_KEY}"\n')
        is_told('vault.toml:2: a vault has no such setting; the nearest is "secret_access_key"', "list")
        usual.write_text(f'secret_access_key = {SECRET_KEY}\n')
        is_told("vault.toml:1: can't be read as TOML", "list")
        self.assertEqual(told("list", "--patience", "0")[0], 2)
        self.assertEqual(told("fetch")[0], 2)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
