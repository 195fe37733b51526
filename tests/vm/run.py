#!/usr/bin/env python3
"""Boots the station's image in an emulated machine and works with it: what the monitor shows, the hands, a pulled plug. `./station vm` runs it.

Each line that it prints is "ok: .." or "FAILED: ..". What can't run has failed. The image that is tested is a copy with three things added
on its data partition (`prepare`): a root shell on a port of its own, the devices' ports in the settings, and more patience of systemd, because the emulation is
some thirty times slower than a workstation."""
import argparse
import base64
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

from machine import Gone, Machine

HERE = pathlib.Path(__file__).parent
DECK = "/var/lib/prismesh/models/sample.k"
SIZE = (960, 600)
PATIENCE = "[Service]\nWatchdogSec=600s\nTimeoutStartSec=600s\n"
SETTINGS = """[display]
profile = "prism-mask"
[eye_tracker]
driver = "dynasight"
port = "/dev/serial/by-id/usb-QEMU_QEMU_USB_SERIAL_T0-if00-port0"
[prism_servo]
driver = "dynamixel"
port = "/dev/serial/by-id/usb-QEMU_QEMU_USB_SERIAL_T1-if00-port0"
baud = 57600
"""
FIXED_EYES = """[Service]
ExecStart=
ExecStart=/usr/bin/prismesh-kiosk --runtime-dir /run/prismesh --fullscreen --eye 0,0,650 --profile prism-mask-columns --trace
"""
AGENT = {"/var/lib/test/agent.sh": (HERE / "agent.sh").read_text(), "/etc/systemd/system/agent.service": (HERE / "agent.service").read_text(),
         "/etc/systemd/system/multi-user.target.wants/agent.service": "-> ../agent.service"}
KIOSK = "prismesh-kiosk --runtime-dir /run/prismesh"


class Picture:
    """RGB, three bytes a pixel, by rows; read from any format that ImageMagick knows."""
    def __init__(self, path):
        text = subprocess.run(["convert", path, "-depth", "8", "ppm:-"], check=True, capture_output=True).stdout
        head = text.split(None, 4)
        self.size = (int(head[1]), int(head[2]))
        self.bytes = text[len(text) - self.size[0] * self.size[1] * 3:]

    def save(self, path):
        head = f"P6 {self.size[0]} {self.size[1]} 255\n".encode()
        subprocess.run(["convert", "ppm:-", str(path)], input=head + self.bytes, check=True)

    def differs(self, other):
        """The number of pixels that are others."""
        return sum(1 for at in range(0, len(self.bytes), 3) if self.bytes[at:at + 3] != other.bytes[at:at + 3])

    def alternates(self, step):
        """The number of pixels that are much unlike their neighbour at this step, in pixels, and like the one beyond."""
        found, row = 0, self.size[0]
        for at in range(2 * step, row * self.size[1]):
            if at % row < 2:
                continue
            here, near, far = (self.bytes[3 * place:3 * place + 3] for place in (at, at - step, at - 2 * step))
            unlike = max(abs(a - b) for a, b in zip(here, near))
            found += 1 if unlike > 12 and max(abs(a - b) for a, b in zip(here, far)) < unlike / 2 else 0
        return found

    def is_woven(self):
        """Two eyes' pictures alternate by columns: what no flat picture does, whose thin lines run in all directions."""
        return self.alternates(1) > 2 * self.alternates(self.size[0])


class Proof:
    def __init__(self):
        self.failed = 0

    def check(self, what, holds, why=""):
        print(("ok: " if holds else "FAILED: ") + what + (f"\n    {why}" if why and not holds else ""), flush=True)
        self.failed += 0 if holds else 1
        return holds


def partition(disk, name):
    """Where a partition of a disk begins, and its length, in bytes."""
    table = json.loads(subprocess.run(["sfdisk", "-J", disk], check=True, capture_output=True).stdout)["partitiontable"]
    part = next(part for part in table["partitions"] if part.get("name") == name)
    sector = table.get("sectorsize", 512)
    return part["start"] * sector, part["size"] * sector


def prepare(image, disk, files):
    """Copies the image and gives it a data partition with these files, by path below /etc and /var: their text, bytes, or "-> " and a link's target.
    The root can't be changed: a station's own settings come in the same way. Needs root, whose files they are."""
    subprocess.run(["cp", "--sparse=always", image, disk], check=True)
    folder = pathlib.Path(disk).parent / "data"
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("etc", "etc.work", "var"):
        (folder / name).mkdir(parents=True)
    (folder / "format").write_text("1\n")
    for path, text in files.items():
        at = folder / path.lstrip("/")
        at.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(text, bytes):
            at.write_bytes(text)
        elif text.startswith("-> "):
            at.symlink_to(text[3:])
        else:
            at.write_text(text)
    start, size = partition(disk, "prismesh-data")
    subprocess.run(["mke2fs", "-q", "-F", "-t", "ext4", "-b", "4096", "-L", "prismesh-data", "-d", str(folder), "-E", f"offset={start},nodiscard", str(disk),
                    str(size // 4096)], check=True)


def machine(out, disk, name, devices=(None, None), snapshot=False, more=()):
    variables = out / "OVMF_VARS.fd"
    shutil.copy("/usr/share/OVMF/OVMF_VARS_4M.fd", variables)
    firmware = ["-drive", "if=pflash,format=raw,readonly=on,file=/usr/share/OVMF/OVMF_CODE_4M.fd", "-drive",
                f"if=pflash,format=raw,file={variables}"]
    console = open(out / f"{name}.console", "w")
    return Machine(out, disk, boot=firmware, size=SIZE, devices=devices, snapshot=snapshot, more=more,
                   log=lambda text: print(text, file=console, flush=True))


def kiosk_has_drawn(guest, limit):
    return guest.wait_until("[ $(systemctl is-active prismesh-kiosk) = active ]", limit)


def picture(guest, name):
    return Picture(guest.screen(name))


def settled(guest, name, quiet=12, limit=240):
    """Waits until the screen has been the same for some seconds; returns it."""
    last, since, end = None, time.time(), time.time() + limit
    while time.time() < end:
        now = picture(guest, name)
        if last is None or now.bytes != last.bytes:
            last, since = now, time.time()
        if time.time() - since > quiet:
            return now
        time.sleep(2)
    raise Gone(f"the screen doesn't come to rest within {limit} s")


def changes(guest, before, name, limit=180):
    """Waits until the screen is another; returns it."""
    end = time.time() + limit
    while time.time() < end:
        now = picture(guest, name)
        if now.bytes != before.bytes:
            return now
        time.sleep(2)
    raise Gone(f"the screen doesn't change within {limit} s")


def session(guest, what, **options):
    return guest.run(f"prismesh session --runtime-dir /run/prismesh {what}", **options)


def state(guest):
    """The document as modeld tells it, without what may differ after a crash."""
    text = session(guest, "state")
    return "\n".join(line for line in text.splitlines() if "recovered" not in line)


def fetch(guest, path):
    return base64.b64decode(guest.run(f"base64 -w0 {path}", limit=120))


def boots(proof, out, image, agent):
    """The image without our programs: what a boot costs anyway."""
    disk = str(out / "bare.img")
    prepare(image, disk, {**agent, "/etc/systemd/system/prismesh.target": "-> /dev/null", "/etc/systemd/system/seatd.service": "-> /dev/null"})
    guest = machine(out, disk, "bare", snapshot=True)
    try:
        guest.wait_for_shell()
        return guest.wait_until("[ $(systemctl is-active multi-user.target) = active ]", 120)
    finally:
        guest.kill()
        os.unlink(disk)


def shows(proof, guest, bare_s):
    first_s = kiosk_has_drawn(guest, 400)
    proof.check(f"the kiosk shows its first picture after {first_s:.0f} s; multi-user target without our programs: {bare_s:.0f} s", True)
    proof.check("that is at most twice as long", first_s <= 2 * bare_s)
    said = guest.run("journalctl -b --no-pager -u prismesh-kiosk -o cat")
    proof.check("the kiosk says what it shows on", "shows on Virtual-1 of /dev/dri/card0" in said, said)
    proof.check("no unit has failed", guest.run("systemctl --failed --no-legend").strip() == "", guest.run("systemctl --failed"))
    pids = "$(systemctl show -P MainPID prismesh-modeld prismesh-deviced prismesh-kiosk)"
    users = guest.run(f"for pid in {pids}; do stat -c %U /proc/$pid; done").split()
    proof.check("each program runs as its own user", sorted(users) == ["prismesh-deviced", "prismesh-kiosk", "prismesh-modeld"], str(users))


def same_picture(proof, out, guest):
    guest.run(f"cp /usr/share/doc/prismesh/sample.k {DECK} 2>/dev/null || prismesh sample --elements 2000 -o {DECK} >/dev/null")
    guest.run(f"chgrp prismesh {DECK} && chmod 664 {DECK}")
    settled(guest, "empty")
    session(guest, f"open {DECK}", limit=120)
    # The status line changes long before the model is drawn.
    guest.wait_until("journalctl -b -o cat --no-pager -u prismesh-kiosk | grep -qE '^picture [0-9]+ generation [0-9]'", 300)
    shown = settled(guest, "opened")
    shown.save(out / "opened.png")
    guest.run("mkdir -p /tmp/shots && chown prismesh-kiosk /tmp/shots")
    guest.run("runuser -u prismesh-kiosk -- env XDG_CONFIG_HOME=/var/lib/prismesh-kiosk HOME=/var/lib/prismesh-kiosk "
              f"{KIOSK} --size {SIZE[0]}x{SIZE[1]} --eye 0,0,650 --profile prism-mask-columns --headless-frames 1 --shots /tmp/shots", limit=400)
    (out / "headless.png").write_bytes(fetch(guest, "/tmp/shots/*.png"))
    drawn = Picture(out / "headless.png")
    proof.check(f"the monitor has {SIZE[0]}x{SIZE[1]} pixels", shown.size == SIZE, str(shown.size))
    different = shown.differs(drawn) if shown.size == drawn.size else -1
    proof.check("what the monitor shows is the headless kiosk's picture, bit for bit", different == 0, f"{different} pixels differ")
    proof.check("and it is woven of two eyes' pictures", shown.is_woven())


def tracked(proof, guest):
    # Where the emulation is late by more than the motor's own patience, the motor switches itself off, as it must.
    devices = "prismesh devices --runtime-dir /run/prismesh"
    said = ""
    for _ in range(30):
        said = guest.run(f"{devices} --rearm >/dev/null 2>&1; {devices}", check=False, limit=180)[1]
        if "eye tracker: tracking (dynasight" in said and "prism servo: following (dynamixel" in said:
            break
        time.sleep(1)
    proof.check("the eye tracker's records arrive through its USB adapter", "eye tracker: tracking (dynasight" in said, said)
    proof.check("the servo answers through its own", "prism servo: following (dynamixel" in said, said)


def works_by_hand(proof, out, guest):
    """With mouse and keyboard only: picks a face of the model, lifts it, saves."""
    before = fetch(guest, DECK)
    rest = settled(guest, "before")
    guest.click(SIZE[0] * 0.5, SIZE[1] * 0.5)
    changes(guest, rest, "picked")
    picked = settled(guest, "picked")
    picked.save(out / "picked.png")
    selected = state(guest)
    proof.check("a click of the tablet selects nodes", "; 0 nodes selected" not in selected, selected)
    guest.key("n")
    changes(guest, picked, "number")  # a field whose caret blinks
    for code in ("5", "ret"):
        time.sleep(5)
        guest.key(code)
    guest.wait_until("prismesh session --runtime-dir /run/prismesh state | grep -qE '^unsaved edits'", 120)
    settled(guest, "lifted").save(out / "lifted.png")
    guest.key("ctrl", "s")
    guest.wait_until("prismesh session --runtime-dir /run/prismesh state | grep -qE '^no unsaved edits'", 120)
    after = fetch(guest, DECK)
    changed = [pair for pair in zip(before.splitlines(), after.splitlines()) if pair[0] != pair[1]]
    proof.check(f"the keyboard lifts them and saves the deck: {len(changed)} lines are others", 0 < len(changed) < 2654, str(len(changed)))
    proof.check("and no line came or went", len(before.splitlines()) == len(after.splitlines()))


def at_rest(proof, guest):
    """What reaches the disk while nobody works. The devices are off: the emulation is too slow for the servo's line, and deviced logs each loss."""
    guest.run("systemctl stop prismesh-deviced.socket prismesh-deviced.service")
    settled(guest, "rest", quiet=20)
    guest.run("systemctl stop systemd-tmpfiles-clean.timer; journalctl --sync; sync; touch /run/rest")
    sectors = "awk '{print $7}' /sys/block/vda/stat"
    first = int(guest.run(sectors))
    time.sleep(120)
    written = int(guest.run(sectors)) - first
    changed = guest.run("find /data -xdev -newer /run/rest -type f; journalctl -b --no-pager -o short-monotonic | tail -12") if written else ""
    proof.check("nothing is written to the disk in two minutes of rest", written == 0, f"{written} sectors; changed files and the last log lines:\n{changed}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("image")
    parser.add_argument("--programs", required=True, help="folder of vm_devices")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    out = pathlib.Path(arguments.out).absolute()
    out.mkdir(parents=True, exist_ok=True)
    proof = Proof()
    agent = AGENT
    patience = {f"/etc/systemd/system/prismesh-{name}.service.d/patience.conf": PATIENCE for name in ("modeld", "deviced", "kiosk")}
    devices = subprocess.Popen([f"{arguments.programs}/vm_devices"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    ports = dict(devices.stdout.readline().split() for _ in range(2))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the machine ends too
    began = time.time()
    guest = None
    try:
        bare_s = boots(proof, out, arguments.image, agent)
        disk = str(out / "disk.img")
        prepare(arguments.image, disk, {**agent, **patience, "/etc/prismesh/prismesh.toml": SETTINGS,
                                        "/etc/systemd/system/prismesh-kiosk.service.d/eyes.conf": FIXED_EYES})
        serial = (ports["tracker"], ports["servo"])
        guest = machine(out, disk, "first", serial)
        guest.wait_for_shell()
        shows(proof, guest, bare_s)
        same_picture(proof, out, guest)
        works_by_hand(proof, out, guest)

        # The plug is pulled in the middle of edits.
        session(guest, """edit '{"edit":"select","expr":"5000001-5000040"}'""")
        for distance in (3, -1, 2):
            session(guest, f"""edit '{{"edit":"lift","distance":{distance}}}'""")
        acknowledged = state(guest)
        guest.run("rm /etc/systemd/system/prismesh-kiosk.service.d/eyes.conf && sync")  # from now on it follows the eyes
        guest.run("""(while :; do prismesh session --runtime-dir /run/prismesh edit '{"edit":"lift","distance":0.001}'; done) >/dev/null 2>&1 &""")
        time.sleep(3)
        guest.kill()
        guest = machine(out, disk, "second", serial)
        guest.wait_for_shell()
        kiosk_has_drawn(guest, 400)
        guest.wait_until("prismesh session --runtime-dir /run/prismesh state | grep -q sample.k", 200)
        undone = ""
        for _ in range(400):
            undone = state(guest)
            if undone == acknowledged:
                break
            if guest.run("prismesh session --runtime-dir /run/prismesh undo", check=False)[0] != 0:
                break
        proof.check("after the plug was pulled, the last model is open with every acknowledged edit", undone == acknowledged,
                    f"before:\n{acknowledged}\nafter:\n{undone}")
        tracked(proof, guest)
        picture(guest, "again").save(out / "again.png")
        at_rest(proof, guest)
        guest.power_off(120)
        proof.check("it powers off", True)
    except Gone as problem:
        proof.check("the machine did as it was asked", False, str(problem))
        if guest is not None and guest.process.poll() is None:
            try:
                print(guest.run("journalctl -b --no-pager | tail -60", check=False, limit=60)[1])
                guest.screen("last")
            except Gone:
                pass
    finally:
        if guest is not None:
            guest.kill()
        devices.stdin.close()
        devices.wait()
    print(f"{time.time() - began:.0f} s; pictures and consoles are in {out}")
    print("all is well" if proof.failed == 0 else f"{proof.failed} checks failed")
    return 1 if proof.failed else 0


if __name__ == "__main__":
    sys.exit(main())
