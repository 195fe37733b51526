"""A session of edits and uploads on a disk of its own, whose power is cut, and what is left of it."""
import filecmp
import json
import pathlib
import random
import shutil
import subprocess
import tempfile
import time

import ledger
import machine
import write_log
from station import Failed, Station

STEPS_OF_A_RECORD = 40  # of each client
SPOILT = 0.25  # of the images have another bit somewhere
FREE_STEPS = 100000  # of a session that only a cut ends


def folders():
    """A folder for a session, which may not lie below /dev, where the guest has devices of its own; and one for images."""
    return (pathlib.Path(tempfile.mkdtemp(prefix="power-cuts-")), pathlib.Path(tempfile.mkdtemp(prefix="power-cuts-", dir=machine.memory_folder())))


class Session:
    """A disk with a deck and a paired station, the ledger of all that is done on it, and the judge."""

    def __init__(self, work, images, programs, seed, environment=None):
        """work, images: of folders(). environment: of the daemons in the guest (station.py)."""
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
        token = station.pair("power cuts")
        station.stop()
        return token

    def boot(self, name, disks=(), **more):
        settings = {"name": name, "programs": str(self.programs), "token": self.token, "tokens": self.ledger.tokens, "seed": self.seed, "steps": FREE_STEPS, "options": self.options,
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
            if self.wrong:
                break
            line = json.loads(raw)
            if "failed" in line:
                raise RuntimeError(line["failed"])
            if "lost" in line:
                self.wrong.append(f"the station doesn't start: {line['lost']}")
            elif "facts" in line:
                self.wrong += [f"{line['facts']}: {each}" for each in self.ledger.judge(self.work / "out" / line["facts"])]
            else:
                self.wrong += self.ledger.read(raw)
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

    def recover_here(self, lines, name, spoil=None):
        """Lets the station recover on this machine from what the image `copy` holds, and judges it by these lines of the ledger. spoil: chance, by
        which the disk gives back another bit somewhere."""
        wrong = machine.check_disk(self.images / "copy")
        if wrong:
            return wrong
        machine.take_out(self.images / "copy", self.work / "disk")
        where = f", {spoil_a_bit(self.work / 'disk', spoil)}" if spoil else ""
        out = self.work / "out" / name
        out.mkdir(parents=True)
        station = Station(self.programs, self.work / "disk", out, self.work / "run", self.environment)
        told = ledger.Ledger()
        for line in lines:
            wrong += told.read(line)
        if wrong:
            return wrong
        try:
            station.facts(out, self.token, told.tokens)
            wrong = [each + where for each in (told.judge_spoilt(out) if spoil else told.judge(out))]
        except Failed as problem:
            # With another bit in it, a file may be refused.
            wrong = [] if spoil and "damaged" in str(problem) else [f"the station doesn't start: {problem}{where}"]
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
            session.follow()
            if not session.wrong:
                raise RuntimeError("the guest has ended:\n" + running.said())
        if last or session.wrong:
            return
        before = session.line_count()
        wanted = chance.randrange(1, chance.choice((20, 60, 200)))
        session.wait(running, lambda: session.line_count() - before >= wanted)
        time.sleep(chance.random() * 0.03)
        if running.process.poll() is not None:
            session.follow()
            raise RuntimeError("the guest has ended:\n" + running.said())
    finally:
        running.pull_the_plug()
        session.check_file_system(name)


def record(session, steps):
    """Runs a session whose writes are recorded on the image `log`; `base` is the disk before it. Returns the lines of its ledger."""
    subprocess.run(["cp", "--sparse=always", session.images / "image", session.images / "base"], check=True)
    with open(session.images / "log", "wb") as file:
        file.truncate(write_log.LOG_BYTES)
    running = session.boot("recorded", disks=[session.images / "log"], record=True, steps=steps)
    try:
        running.process.wait(300)
    finally:
        running.pull_the_plug()
    lines = session.lines.read_bytes().splitlines()
    for line in map(json.loads, lines):
        if "failed" in line or "lost" in line:
            raise RuntimeError(line.get("failed") or line["lost"])
    if not any(b'"facts"' in line for line in lines):
        raise RuntimeError("the guest has ended:\n" + running.said())
    return lines


def try_write_cache(programs, seed, count, steps=STEPS_OF_A_RECORD, environment=None, keep=True):
    """Records what a session writes to its disk, makes images of what a disk with a write cache may hold after a cut, and lets the station recover
    on each, up to the first that is wrong. Returns the number of images, of flushes, and what is wrong. keep: the folders, if anything is."""
    work, images = folders()
    session = Session(work, images, programs, seed, environment)
    wrong, made = [], 0
    try:
        lines = record(session, steps)
        moments = [moment for moment in write_log.moments(write_log.read_log(images / "log")) if moment.mark > 0 or moment.durable]
        ready = next(number for number, line in enumerate(lines, 1) if b'"facts"' in line)
        chance = random.Random(seed)
        seeds = {}
        for number in chance.choices([each for each, moment in enumerate(moments) if moment.mark >= ready], k=count):
            seeds.setdefault(number, []).append(chance.randrange(1 << 30))
        for number, moment in enumerate(moments):
            with open(images / "base", "r+b") as file:
                for entry in moment.durable:
                    write_log.put(file, entry)
            for image_seed in seeds.get(number, ()) if not wrong else ():
                subprocess.run(["cp", "--sparse=always", images / "base", images / "copy"], check=True)
                with open(images / "copy", "r+b") as file:
                    how = write_log.put_by_chance(file, moment.open, random.Random(image_seed))
                chance = random.Random(image_seed)
                found = session.recover_here(lines[:moment.mark], f"image-{number}-{image_seed}", chance if chance.random() < SPOILT else None)
                made += 1
                wrong += [f"before flush {number} of {len(moments)}, of {len(moment.open)} writes stored: {how} (seed {image_seed}): {each}" for each in found]
                if wrong:
                    break
        if not wrong:
            check_record(session, moments[-1])
        return made, len(moments), wrong
    finally:
        clear(session, wrong, keep)


def check_record(session, last):
    """All that was recorded gives the disk as it is: no write was missed."""
    with open(session.images / "base", "r+b") as file:
        for entry in last.open:
            write_log.put(file, entry)
    if not filecmp.cmp(session.images / "base", session.images / "image", shallow=False):
        raise RuntimeError("the record of the disk's writes isn't whole")


def cut_one_disk(programs, seed, count, environment=None, keep=True):
    """Cuts the power of one disk again and again, up to the first time that something is wrong. Returns what was acknowledged on it, and what is
    wrong. keep: the folders, if anything is."""
    work, images = folders()
    chance = random.Random(seed)
    session = Session(work, images, programs, seed, environment)
    try:
        for number in range(count + 1):
            session.seed = seed * 1000 + number
            cut_once(session, f"boot-{number}", chance, number == count)
            session.follow()
            if session.wrong:
                return session.ledger.acknowledged, session.wrong
        session.check_bytes(f"boot-{count}")
        return session.ledger.acknowledged, session.wrong
    finally:
        clear(session, session.wrong, keep)


def spoil_a_bit(disk, chance):
    """Returns where."""
    journals = sorted((disk / "state" / "modeld").glob("*.journal"))
    stored = sorted(path for folder in ("sha256", "models") for path in (disk / "state" / "intake").glob(f"**/{folder}/**/*") if path.is_file())
    files = [path for path in chance.choice((journals, journals, stored)) if path.stat().st_size > 0]
    if not files:
        return "with no bit changed"
    path = chance.choice(files)
    content = bytearray(path.read_bytes())
    at, bit = chance.randrange(len(content)), 1 << chance.randrange(8)
    content[at] ^= bit
    path.write_bytes(content)
    return f"with another bit at byte {at} of {len(content)} of {path.relative_to(disk)}"


def clear(session, wrong, keep):
    if wrong and keep:
        wrong.append(f"with seed {session.seed}; the disk is in {session.images}, what was found in {session.work}")
        return
    shutil.rmtree(session.work)
    shutil.rmtree(session.images)
