#!/usr/bin/env python3
"""Pulls the plug of a machine that edits and takes models, and looks at what is left: the real prismesh-modeld and prismesh-intake on a real ext4,
under user-mode Linux. Then it records what such a machine writes, and looks at what a disk with a write cache may hold after a cut. Skipped,
aloud, without user-mode Linux.

    cut.py PROGRAMS [--cuts N] [--images N] [--seed S] [--jobs N]     PROGRAMS: the folder of the built programs
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import ledger  # noqa: E402
import machine  # noqa: E402
import write_log  # noqa: E402
from station import Failed, Station  # noqa: E402

CUTS_FOR_EACH_DISK = 10  # then a new one, so that checking what is there doesn't outgrow the work
IMAGES_OF_EACH_RECORD = 250
STEPS_OF_A_RECORD = 40  # of each client
FREE_STEPS = 100000  # of a session that only a cut ends


class Session:
    """A disk with a deck and a paired station, the ledger of all that is done on it, and the judge."""

    def __init__(self, work, images, programs, seed, environment=None):
        """work: a folder that doesn't lie below /dev, where the guest has devices of its own. images: a folder in memory, where there is one."""
        self.work, self.images, self.programs, self.seed = pathlib.Path(work), pathlib.Path(images), pathlib.Path(programs).resolve(), seed
        for folder in ("disk", "out"):
            (self.work / folder).mkdir()
        self.environment = environment or {}
        # No help of ext4 for programs that don't flush before they rename; now and then even less order than it usually keeps.
        self.options = "noauto_da_alloc,commit=1,data=" + ("ordered", "writeback")[seed % 2]
        self.token = self._prepare()
        machine.make_disk(self.images / "image", self.work / "disk")
        for each in (self.work / "disk").iterdir():
            shutil.rmtree(each)  # from here on this is where the image is mounted
        self.lines = self.work / "out" / "ledger"
        self.lines.touch()
        self.read = 0
        self.ledger = ledger.Ledger()
        self.wrong = []

    def _prepare(self):
        """Pairing needs a running station; once is enough."""
        ledger.write_deck(self.work / "disk" / "deck")
        (self.work / "disk" / "copies").mkdir()
        station = Station(self.programs, self.work / "disk", self.work, self.work / "run")
        station.start()
        token = station.pair()
        station.stop()
        return token

    def boot(self, name, disks=(), **more):
        settings = {"name": name, "programs": str(self.programs), "token": self.token, "seed": self.seed, "steps": FREE_STEPS, "options": self.options,
                    "environment": self.environment, **more}
        return machine.Machine(self.work, settings, [self.images / "image", *disks])

    def line_count(self):
        return self.lines.read_bytes().count(b"\n")

    def wait(self, running, ready, limit=120):
        """Until ready() or the machine's end. Returns whether it is ready."""
        end = time.monotonic() + limit
        while not ready():
            if running.process.poll() is not None:
                return ready()
            if time.monotonic() > end:
                raise RuntimeError("the guest is slow:\n" + running.said() + self.lines.read_text()[-2000:])
            time.sleep(0.002)
        return True

    def follow(self):
        """Reads the ledger's new lines, and judges where the guest has written what a start found. A line that was cut off was never seen by a user."""
        text = self.lines.read_bytes()
        end = text.rfind(b"\n") + 1
        for raw in text[self.read:end].splitlines():
            line = json.loads(raw)
            if "failed" in line:
                raise RuntimeError(line["failed"])
            if "facts" in line:
                self.wrong += [f"{line['facts']}: {each}" for each in self.ledger.judge(self.work / "out" / line["facts"])]
            else:
                self.ledger.read(raw)
        self.read = len(text)
        # What was cut off mustn't run into the next line.
        if end < len(text):
            with open(self.lines, "ab") as file:
                file.write(b"\n")
            raise RuntimeError("a line of the ledger was cut off")

    def check_file_system(self, name):
        copy = self.images / "copy"
        subprocess.run(["cp", "--sparse=always", self.images / "image", copy], check=True)
        self.wrong += [f"{name}: {each}" for each in machine.check_disk(copy)]
        copy.unlink()


    def recover_here(self, lines, name):
        """Lets the station recover on this machine from what the image `copy` holds, and judges it by these lines of the ledger."""
        wrong = machine.check_disk(self.images / "copy")
        if wrong:
            return wrong
        machine.take_out(self.images / "copy", self.work / "disk")
        out = self.work / "out" / name
        out.mkdir(parents=True)
        station = Station(self.programs, self.work / "disk", out, self.work / "run")
        told = ledger.Ledger()
        for line in lines:
            told.read(line)
        try:
            station.facts(out, self.token)
            wrong = told.judge(out)
        except Failed as problem:
            wrong = [f"the station doesn't start: {problem}"]
        finally:
            station.stop(by_kill=True)
        if not wrong:
            shutil.rmtree(out)
        return wrong

    def check_bytes(self, name):
        """The command line makes the same bytes of the deck as it was at the beginning and of all edits that were acknowledged and not undone."""
        script = self.work / "edits"
        script.write_text("".join(json.dumps({"edit": "translate", "on": f"{first}-{last}", "by": [0, 0, by], "falloff": {"profile": "constant"}}) + "\n"
                                  for first, last, by in self.ledger.edits))
        ledger.write_deck(self.work / "deck")
        subprocess.run([self.programs / "prismesh", "edit", self.work / "deck" / "main.k", "--script", script, "-o", self.work / "replayed" / "main.k"],
                       check=True, capture_output=True)
        for path in sorted((self.work / "deck").iterdir()):
            if (self.work / "replayed" / path.name).read_bytes() != (self.work / "out" / name / "copy" / path.name).read_bytes():
                self.wrong.append(f"{name}: {path.name} has other bytes than the command line makes of {len(self.ledger.edits)} edits")


def cut_once(session, name, chance, last):
    """Boots: the guest recovers and writes what it has; then it works, and the plug is pulled after some lines and a moment more. Sometimes it is
    pulled while the guest recovers."""
    running = session.boot(name)
    try:
        if not last and chance.random() < 0.15:
            session.wait(running, lambda: (session.work / "out" / name / "found").exists())
            time.sleep(chance.random() * 0.6)
            return
        if not session.wait(running, lambda: f'"facts": "{name}"' in session.lines.read_text()):
            raise RuntimeError("the guest has ended: " + running.said() + session.lines.read_text()[-2000:])
        if last:
            return
        before = session.line_count()
        wanted = chance.randrange(1, chance.choice((20, 60, 200)))
        session.wait(running, lambda: session.line_count() - before >= wanted)
        time.sleep(chance.random() * 0.03)
        if running.process.poll() is not None:
            raise RuntimeError("the guest has ended by itself:\n" + running.said())
    finally:
        running.pull_the_plug()
        session.check_file_system(name)


def try_write_cache(programs, seed, steps, count, environment=None):
    """Records what a session writes to its disk, makes images of what a disk with a write cache may hold after a cut, and lets the station recover
    on each. Returns the number of images, of flushes, and what is wrong."""
    work = pathlib.Path(tempfile.mkdtemp(prefix="power-cuts-"))
    images = pathlib.Path(tempfile.mkdtemp(prefix="power-cuts-", dir=machine.memory_folder()))
    session = Session(work, images, programs, seed, environment)
    subprocess.run(["cp", "--sparse=always", images / "image", images / "base"], check=True)
    with open(images / "log", "wb") as file:
        file.truncate(write_log.LOG_BYTES)
    running = session.boot("recorded", disks=[images / "log"], record=True, steps=steps)
    try:
        running.process.wait(300)
    finally:
        running.pull_the_plug()
    lines = session.lines.read_bytes().splitlines()
    for line in lines:
        if "failed" in json.loads(line):
            raise RuntimeError(json.loads(line)["failed"])
    chance = random.Random(seed)
    moments = [moment for moment in write_log.moments(write_log.read_log(images / "log")) if moment.mark > 0 or moment.durable]
    ready = next(number for number, line in enumerate(lines, 1) if b'"facts"' in line)
    tried = {}
    for number in chance.choices([each for each, moment in enumerate(moments) if moment.mark >= ready], k=count):
        tried.setdefault(number, []).append(chance.randrange(1 << 30))
    wrong = []
    for number, moment in enumerate(moments):
        with open(images / "base", "r+b") as file:
            for entry in moment.durable:
                write_log.put(file, entry)
        for image_seed in tried.get(number, ()):
            subprocess.run(["cp", "--sparse=always", images / "base", images / "copy"], check=True)
            with open(images / "copy", "r+b") as file:
                how = write_log.put_by_chance(file, moment.open, random.Random(image_seed))
            found = session.recover_here(lines[:moment.mark], f"image-{number}-{image_seed}")
            wrong += [f"flush {number} of {len(moments)}, of {len(moment.open)} writes stored: {how} ({image_seed}): {each}" for each in found]
            if wrong:
                wrong.append(f"the images are in {images}, what was found in {work}")
                return len(tried), len(moments), wrong
    shutil.rmtree(work)
    shutil.rmtree(images)
    return sum(len(each) for each in tried.values()), len(moments), wrong


def cut_one_disk(programs, count, seed):
    """Cuts the power of one disk again and again. Returns what was acknowledged on it, and what is wrong."""
    work = pathlib.Path(tempfile.mkdtemp(prefix="power-cuts-"))
    images = pathlib.Path(tempfile.mkdtemp(prefix="power-cuts-", dir=machine.memory_folder()))
    chance = random.Random(seed)
    session = Session(work, images, programs, seed)
    for number in range(count + 1):
        session.seed = seed * 1000 + number
        cut_once(session, f"boot-{number}", chance, number == count)
        session.follow()
        if session.wrong:
            session.wrong.append(f"that is after {number} cuts with seed {seed}; the disk is in {images}, what was found in {work}")
            return session.ledger.acknowledged, session.wrong
    session.check_bytes(f"boot-{count}")
    shutil.rmtree(work)
    shutil.rmtree(images)
    return session.ledger.acknowledged, session.wrong


def cuts(programs, count, seed, jobs):
    disks = [min(CUTS_FOR_EACH_DISK, count - begin) for begin in range(0, count, CUTS_FOR_EACH_DISK)]
    edits = models = failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for acknowledged, wrong in pool.map(lambda number: cut_one_disk(programs, disks[number], seed + number), range(len(disks))):
            edits += acknowledged["editor"]
            models += acknowledged["sender"]
            failed += bool(wrong)
            if wrong:
                print("FAILED: " + "\n    ".join(wrong), flush=True)
    print(f"{count} power cuts on {len(disks)} disks: {edits} acknowledged edits and saves, {models} acknowledged publications and removals"
          + (f"; {failed} disks FAILED" if failed else ", all there, and nothing else"))
    return 1 if failed else 0


def write_caches(programs, count, seed, jobs):
    records = [min(IMAGES_OF_EACH_RECORD, count - begin) for begin in range(0, count, IMAGES_OF_EACH_RECORD)]
    images = flushes = failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for made, flushed, wrong in pool.map(lambda number: try_write_cache(programs, seed + number, STEPS_OF_A_RECORD, records[number]), range(len(records))):
            images += made
            flushes += flushed
            failed += bool(wrong)
            if wrong:
                print("FAILED: " + "\n    ".join(wrong), flush=True)
    print(f"{images} states of a disk with a write cache, between {flushes} flushes of {len(records)} sessions"
          + (f"; {failed} sessions FAILED" if failed else ": recovered, all that was acknowledged is there, and nothing else"))
    return 1 if failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs")
    parser.add_argument("--cuts", type=int, default=10)
    parser.add_argument("--images", type=int, default=20, help="states of a disk with a write cache")
    parser.add_argument("--seed", type=int, default=int(os.environ.get("PRISMESH_SEED", "1")))
    parser.add_argument("--jobs", type=int, default=1, help="machines at a time")
    given = parser.parse_args()
    missing = machine.missing()
    if missing:
        print(f"SKIPPED: no power is cut: {missing} isn't installed")
        return 77
    status = cuts(given.programs, given.cuts, given.seed, given.jobs) if given.cuts else 0
    return write_caches(given.programs, given.images, given.seed, given.jobs) or status if given.images else status


sys.exit(main())
