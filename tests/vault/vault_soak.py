#!/usr/bin/env python3
"""Models are pushed to a real Swift and fetched from it over a line that fails at random, by programs that are killed at random.

    vault_soak.py PROGRAMS [--models N] [--seed N]

At any time: a model that is listed is there whole, and a folder that a fetch has made has the source's bytes. In the end all models are there.
"""
import argparse
import hashlib
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

from faulty_line import FaultyLine
from s3_client import S3Client
from swift_store import ACCESS_KEY, REGION, SECRET_KEY, SwiftStore, missing

BUCKET, PIECE = "models", 4 << 20
FAULTS_A_REQUEST, KILLS_A_RUN = 0.2, 0.6


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def fault(dice, request):
    if dice.random() > FAULTS_A_REQUEST:
        return None
    kinds = [("answer", 500), ("answer", 503), ("lose answer",), ("cut answer", dice.randrange(PIECE))]
    if request.method == "PUT" and request.size:
        kinds += [("cut request", dice.randrange(request.size)), ("flip request", dice.randrange(request.size))]
    if request.method == "GET" and "/pieces/" in request.path:
        kinds += [("flip answer", dice.randrange(3000))]
    return dice.choice(kinds)


class Soak:
    def __init__(self, program, folder, store, dice):
        self.program, self.folder, self.dice = program, folder, dice
        self.client = S3Client(store.port, ACCESS_KEY, SECRET_KEY, REGION)
        self.client.make_bucket(BUCKET)
        self.line = FaultyLine(store.port)
        self.lock = threading.Lock()
        self.sources, self.runs, self.killed, self.faults = {}, 0, 0, 0
        self.environment = {**os.environ, "HOME": str(folder), "AWS_ACCESS_KEY_ID": ACCESS_KEY, "AWS_SECRET_ACCESS_KEY": SECRET_KEY, "AWS_REGION": REGION,
                            "PRISMESH_VAULT": f"s3+http://127.0.0.1:{self.line.port}/{BUCKET}"}

    def make_source(self, number):
        """A deck that shares its beginning with the others."""
        folder = self.folder / "sources" / str(number)
        folder.mkdir(parents=True)
        dice = random.Random(0)
        lines = [b"$" + dice.randbytes(39).hex().encode() + b"\n" for _ in range((2 * PIECE + 50_000) // 80)]
        lines[self.dice.randrange(len(lines))] = b"$ %d\n" % number
        (folder / "notes.k").write_bytes(b"*KEYWORD\n" + b"".join(lines) + b"*END\n")
        (folder / "main.k").write_text(f"*KEYWORD\n$ model {number}\n*NODE\n       1             0.0             0.0             0.0\n*INCLUDE\nnotes.k\n*END\n")
        files = contents(folder)
        text = "prismesh-set 1\nmain main.k\n" + "".join(f"{sha256(data)} {len(data)} {path}\n" for path, data in sorted(files.items()))
        self.sources[sha256(text.encode())] = (folder, files)

    def rule(self, request):
        with self.lock:
            chosen = fault(self.dice, request)
            self.faults += chosen is not None
        return chosen

    def run(self, *arguments):
        """False: it was killed, or has given up."""
        self.runs += 1
        self.line.begin(self.rule)
        runner = subprocess.Popen([self.program, "vault", *map(str, arguments), "--patience", "30"], env=self.environment, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        with self.lock:
            kill_at = self.dice.randrange(1, 14) if self.dice.random() < KILLS_A_RUN else None
        while kill_at and runner.poll() is None:
            if len(self.line.requests) >= kill_at:
                runner.send_signal(signal.SIGKILL)
                self.killed += 1
                break
            time.sleep(0.002)
        runner.communicate()
        return runner.returncode == 0

    def complaints(self):
        """What a client that knows nothing of the program's finds wrong."""
        found = []
        for key in self.client.keys(BUCKET):
            kind, _, rest = key.partition("/")
            if kind in ("pieces", "models") and sha256(self.client.get(BUCKET, key)) != rest:
                found.append(f"{key} has other bytes")
        keys = set(self.client.keys(BUCKET))
        for model, (_, files) in self.sources.items():
            if f"models/{model}" not in keys:
                continue
            for path, data in files.items():
                pieces = [sha256(data[at : at + PIECE]) for at in range(0, len(data), PIECE)]
                found += [f"{path} of {model}: pieces/{piece} isn't there" for piece in pieces if f"pieces/{piece}" not in keys]
                if len(pieces) > 1 and self.client.get(BUCKET, f"lists/{sha256(data)}").decode().split("\n")[1:-1] != pieces:
                    found.append(f"the list of {path} of {model} is wrong")
        return found

    def work(self, model):
        source, files = self.sources[model]
        while not self.run("push", source / "main.k"):
            if found := self.complaints():
                return found
        if found := self.complaints():
            return found
        if f"models/{model}" not in self.client.keys(BUCKET):
            return [f"{model} was said to be pushed, and isn't there"]
        back = self.folder / "back" / model
        back.parent.mkdir(exist_ok=True)
        while not self.run("fetch", model, "-o", back):
            if back.exists() and contents(back) != files:
                return [f"{model} was fetched with other bytes"]
            if back.exists():  # it was killed behind the last step
                break
        return [] if contents(back) == files else [f"{model} was fetched with other bytes"]


def main(arguments, folder):
    dice = random.Random(arguments.seed)
    begun = time.monotonic()
    with SwiftStore(folder / "swift") as store:
        soak = Soak(arguments.programs.resolve() / "prismesh", folder, store, dice)
        for number in range(arguments.models):
            soak.make_source(number)
        for model in soak.sources:
            if found := soak.work(model):
                print("\n".join(found))
                return 1
        soak.line.begin()
        verified = subprocess.run([soak.program, "vault", "verify", "--json"], env=soak.environment, capture_output=True, text=True)
        print(f"{arguments.models} models, {soak.runs} runs, {soak.killed} killed, {soak.faults} faults of the line, {time.monotonic() - begun:.0f} s")
        said = json.loads(verified.stdout)
        if verified.returncode or said["models"] != arguments.models or said["faults"]:
            print(verified.stdout, verified.stderr)
            return 1
        if not (soak.killed and soak.faults):
            print("there was too little trouble")
            return 1
    return 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--models", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if why := missing():
        print("SKIPPED: " + why)
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="soak-") as place:
        sys.exit(main(options, pathlib.Path(place)))
