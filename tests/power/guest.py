#!/usr/bin/python3 -SE
"""The first process of the guest: mounts the disk, lets the station recover, writes what it has, then edits and sends until the power is cut.

Its argument is a file of settings that cut.py has written. What it does is written line by line, before and after each step, into a file of
the host, which has each line at once: whatever the guest says it has been told of, the host knows."""
import ctypes
import fcntl
import json
import os
import pathlib
import random
import socket
import struct
import sys
import threading
import traceback

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
sys.dont_write_bytecode = True
import ledger  # noqa: E402
import station as programs  # noqa: E402

LIBRARY = ctypes.CDLL(None, use_errno=True)
POWER_OFF = 0x4321FEDC
NO_ACCESS_TIMES = 1024
RESTING = 8  # the newest models aren't removed, so that what was only half published isn't asked for


def call(result, what):
    if result < 0:
        raise OSError(ctypes.get_errno(), f"{what}: {os.strerror(ctypes.get_errno())}")


def mount(what, where, kind, flags=0, options=""):
    call(LIBRARY.mount(str(what).encode(), str(where).encode(), kind.encode(), flags, options.encode() or None), f"mounting {where}")


def unmount(where):
    call(LIBRARY.umount2(str(where).encode(), 0), f"unmounting {where}")


def raise_loopback():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh14x", b"lo", 1))  # SIOCSIFFLAGS, IFF_UP


class Guest:
    def __init__(self, settings):
        self.settings = settings
        self.work = pathlib.Path(settings["work"])
        self.disk, self.out = self.work / "disk", self.work / "out" / settings["name"]
        mount("proc", "/proc", "proc")
        mount("tmpfs", "/run", "tmpfs")
        mount("none", self.work / "out", "hostfs", 0, str(self.work / "out"))
        raise_loopback()
        self.lines = os.open(self.work / "out" / "ledger", os.O_WRONLY | os.O_APPEND)
        self.lock = threading.Lock()
        self.mark = lambda number: None
        self.count = 0

    def say(self, **line):
        with self.lock:
            os.write(self.lines, json.dumps(line).encode() + b"\n")
            self.count += 1
            self.mark(self.count)

    def run(self):
        device = "/dev/ubda"
        if self.settings.get("record"):
            import write_log
            self.mark = write_log.begin(device, "/dev/ubdb")
            device = write_log.DEVICE
        mount(device, self.disk, "ext4", NO_ACCESS_TIMES, self.settings.get("options", ""))
        self.own_all()
        self.station = programs.Station(self.settings["programs"], self.disk, self.out, "/run/station", self.settings.get("environment"))
        try:
            self.station.facts(self.out, self.settings["token"], self.settings["tokens"])
        except programs.Failed as problem:
            self.say(lost=str(problem))
            return
        self.say(facts=self.settings["name"])
        editor = threading.Thread(target=self.guarded, args=(self.edit,))
        sender = threading.Thread(target=self.guarded, args=(self.send,))
        for thread in (editor, sender):
            thread.start()
        for thread in (editor, sender):
            thread.join()
        self.station.stop(by_kill=True)
        unmount(self.disk)
        if self.settings.get("record"):
            write_log.end()

    def own_all(self):
        """The disk was made by whoever runs the test; here all runs as root."""
        for folder, folders, files in os.walk(self.disk):
            for path in [folder, *(os.path.join(folder, name) for name in files)]:
                if os.lstat(path).st_uid != 0:
                    os.lchown(path, 0, 0)

    def guarded(self, work):
        try:
            work()
        except BaseException:  # noqa: B902  what goes wrong must reach the host
            self.say(failed=traceback.format_exc())

    def step(self, who, do, fields, act):
        self.say(who=who, do=do, **fields)
        try:
            answer = act()
        except programs.Failed as problem:
            self.say(who=who, refused=str(problem))
            raise
        self.say(who=who, done=do, **({"token": answer} if do == "pair" else {}))

    def edit(self):
        chance = random.Random(self.settings["seed"])
        modeld = self.station.modeld
        undoable = 0
        for number in range(self.settings["steps"]):
            kind = chance.choices(("move", "undo", "save", "copy"), (70, 10, 15, 5))[0]
            if kind == "undo" and undoable > 0:
                undoable -= 1
                self.step("editor", "undo", {}, lambda: modeld.ask("apply_edit", edit={"edit": "undo"}))
            elif kind == "save":
                self.step("editor", "save", {}, lambda: modeld.ask("save"))
            elif kind == "copy":
                name = f"{self.settings['name']}-{number}"
                self.step("editor", "copy", {"name": name},
                          lambda name=name: modeld.ask("save", path=str(self.disk / "copies" / name / "main.k"), stays_unsaved=True))
            else:
                undoable += 1
                first = chance.randrange(1, ledger.NODES - 50)
                last = chance.choices((first + 1, first + chance.randrange(2, 50), ledger.NODES), (3, 3, 2))[0]
                by = chance.choice((-1, 1)) * chance.randrange(1, 32) * 0.25
                edit = {"edit": "translate", "on": f"{first}-{last}", "by": [0, 0, by], "falloff": {"profile": "constant"}}
                self.step("editor", "move", {"first": first, "last": last, "by": by}, lambda edit=edit: modeld.ask("apply_edit", edit=edit))

    def send(self):
        chance = random.Random(self.settings["seed"] + 1)
        intake = programs.Intake(self.station.port, self.settings["token"])
        published = []
        for number in range(self.settings["steps"]):
            if len(published) > RESTING and chance.random() < 0.25:
                model = published.pop(chance.randrange(len(published) - RESTING))
                self.step("sender", "remove", {"model": model}, lambda model=model: intake.ask("DELETE", f"/models/{model}"))
                continue
            if chance.random() < 0.05:
                name = f"{self.settings['name']} {number}"
                self.step("sender", "pair", {"name": name}, lambda name=name: self.station.pair(name))
                continue
            files = ledger.upload_files(number, self.settings["seed"])
            model = programs.model_of(files, "main.k")

            def publish(files=files, number=number):
                for content in files.values():
                    intake.upload(content)
                intake.publish(files, "main.k", f"{self.settings['name']} {number}")

            self.step("sender", "publish", {"model": model, "number": number, "seed": self.settings["seed"]}, publish)
            published.append(model)


def main():
    try:
        Guest(json.loads(pathlib.Path(sys.argv[1]).read_text())).run()
    except BaseException:  # noqa: B902  there is nothing above the first process
        traceback.print_exc()
    sys.stdout.flush()
    LIBRARY.reboot(POWER_OFF)


main()
