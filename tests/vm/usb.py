#!/usr/bin/env python3
"""A SpaceMouse and a Falcon on the image's own kernel: usb_device plays them byte by byte over QEMU's usb-redir, and the machine's USB stack, udev,
hidraw, libusb and the installed services do the rest. `./station vm` runs it.

Usage: usb.py build/image/prismesh.img --programs build/bin --out out/vm [--only space-mouse|falcon]. Needs root. Each line is "ok: .." or "FAILED: ..". What
can't run has failed."""
import argparse
import pathlib
import re
import signal
import subprocess
import sys
import time

from machine import Gone
from run import AGENT, DECK, PATIENCE, Proof, fetch, kiosk_has_drawn, machine, prepare, session, settled, state

KIOSK = """[Service]
ExecStart=
ExecStart=/usr/bin/prismesh-kiosk --runtime-dir /run/prismesh --fullscreen --eye 0,0,650 --profile mono --trace
"""
SETTINGS = '[haptic_pen]\ndriver = "falcon"\nfirmware = "falcon.bin"\n'
SELECTED = range(5000001, 5000041)


class UsbDevice:
    """The program that plays a device. Each command has an answer."""
    def __init__(self, programs, kind, socket):
        self.process = subprocess.Popen([f"{programs}/vm_usb_device", kind, socket], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, command):
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        if not answer:
            raise Gone(f"the program that plays a device has ended with {self.process.wait()}")
        return answer

    def do(self, command):
        end = time.time() + 30
        while (answer := self.ask(command)) != "ok":
            if answer != "not yet" or time.time() > end:
                raise Gone(f"the program that plays a device answers {command!r} with {answer!r}")
            time.sleep(0.2)

    def state(self):
        return dict(word.split("=") for word in self.ask("state").split() if "=" in word)

    def end(self):
        self.process.stdin.close()
        self.process.wait()


def socket_path(out, kind):
    return str(out / f"{kind}.usb")


def port(out, kind):
    """QEMU's arguments for a port of the machine."""
    return ["-chardev", f"socket,id={kind},path={socket_path(out, kind)},server=on,wait=off", "-device", f"usb-redir,chardev={kind},id={kind}"]


# --- SpaceMouse ---

REST = ("send 01 00 00 00 00 00 00", "send 02 00 00 00 00 00 00")


def words(*axes):
    return " ".join(f"{each & 0xFF:02X} {each >> 8 & 0xFF:02X}" for each in axes)


def press(mouse, button):
    mouse.do(f"send 03 {1 << (button - 1):02X} 00")
    time.sleep(0.5)
    mouse.do("send 03 00 00")


class Shape:
    """Where the model is in a picture: the middle and the number of coloured pixels of the view, whose ground is grey."""
    def __init__(self, picture):
        width, height = picture.size
        self.pixels = sum_x = sum_y = 0
        for y in range(round(0.07 * height), round(0.88 * height)):
            for x in range(round(0.14 * width), round(0.68 * width)):
                at = 3 * (y * width + x)
                red, green, blue = picture.bytes[at:at + 3]
                if max(red, green, blue) - min(red, green, blue) > 24:
                    self.pixels, sum_x, sum_y = self.pixels + 1, sum_x + x, sum_y + y
        self.x, self.y = sum_x / self.pixels, sum_y / self.pixels


def traced(guest, what):
    """How often the kiosk has said this."""
    return int(guest.run(f"journalctl -b -o cat --no-pager -u prismesh-kiosk | grep -cE '^{what}'", check=False, limit=180)[1])


def drawn_while(guest, mouse, report, first="picture", pictures=3):
    """Holds the cap until the kiosk has said `first` and drawn some pictures since: how long that takes depends on the machine."""
    before = traced(guest, first)
    mouse.do(report)
    end = time.time() + 300
    for what, more in ((first, 1), ("picture", pictures)):
        before = before if what == first else traced(guest, what)
        while traced(guest, what) < before + more:
            if time.time() > end:
                raise Gone(f"the kiosk doesn't say {what!r} while the cap is pushed")
            time.sleep(0.5)


def wait_for_trace(guest, what, before):
    """Waits until the kiosk has said this more often than before."""
    end = time.time() + 300
    while traced(guest, what) <= before:
        if time.time() > end:
            raise Gone(f"the kiosk doesn't say {what!r}")
        time.sleep(0.5)


def rested(guest, before, name):
    """Waits until the kiosk has come to rest once more than before; returns the picture."""
    wait_for_trace(guest, "rests", before)
    return settled(guest, name, quiet=8)


def push(guest, mouse, report, name, first="picture"):
    """Pushes the cap for some pictures; returns the picture at rest."""
    drawn_while(guest, mouse, report, first)
    before = traced(guest, "rests")
    for each in REST:
        mouse.do(each)
    return rested(guest, before, name)


def positions(deck):
    """Of the selected nodes, by number."""
    found, keyword = {}, ""
    for line in deck.decode().splitlines():
        if line.startswith("*"):
            keyword = line.strip()
        elif keyword == "*NODE" and not line.startswith("$") and int(line[:8]) in SELECTED:
            found[int(line[:8])] = tuple(float(line[8 + 16 * axis:24 + 16 * axis]) for axis in range(3))
    return found


def space_mouse(proof, guest, programs, out):
    mouse = UsbDevice(programs, "space-mouse", socket_path(out, "space-mouse"))
    try:
        kiosk_has_drawn(guest, 400)
        guest.run(f"prismesh sample --elements 2000 -o {DECK} >/dev/null && chgrp prismesh {DECK} && chmod 664 {DECK}")
        session(guest, f"open {DECK}", limit=120)
        mouse.do("plug")
        # The machine's tablet and keyboard are HID devices too.
        guest.wait_until("grep -l SpaceNavigator /sys/class/hidraw/*/device/uevent", 90)
        name = guest.run("(cd /sys/class/hidraw; for h in *; do ! grep -q SpaceNavigator $h/device/uevent || echo $h; done)").strip()
        guest.run("udevadm settle", limit=60)
        said = guest.run(f"cat /sys/class/hidraw/{name}/device/uevent; stat -c '%U:%G %a' /dev/{name}; stat -c '%n %U:%G %a' /dev/hidraw*")
        proof.check("the kernel takes the SpaceMouse for a HID device by the names that it gives", "HID_NAME=3Dconnexion SpaceNavigator" in said, said)
        proof.check("the udev rule opens it to the group prismesh", "root:prismesh 660" in said, said)
        guest.wait_until("ls -l /proc/$(systemctl show -P MainPID prismesh-kiosk)/fd | grep -q /dev/hidraw", 120)
        proof.check("the kiosk's unit opens it, as the user prismesh-kiosk", guest.run("stat -c %U /proc/$(systemctl show -P MainPID prismesh-kiosk)").strip() == "prismesh-kiosk")
        rest = settled(guest, "space-rest")
        proof.check("it listens to the device", mouse.state()["listened"] == "1", str(mouse.state()))

        # The device's axes: right, toward the user, down. A third of the way is slow.
        first = Shape(rest)
        for number, (what, report, holds) in enumerate((
                ("to the right moves the picture there", f"send 01 {words(220, 0, 0)}", lambda now: now.x > first.x + 5 and abs(now.y - first.y) < abs(now.x - first.x) / 2),
                ("up moves it up", f"send 01 {words(0, 0, -220)}", lambda now: now.y < first.y - 5 and abs(now.x - first.x) < abs(now.y - first.y) / 2),
                ("toward the user makes it larger", f"send 01 {words(0, 220, 0)}", lambda now: now.pixels > first.pixels * 1.05),
                ("away makes it smaller", f"send 01 {words(0, -220, 0)}", lambda now: now.pixels < first.pixels * 0.95))):
            shown = push(guest, mouse, report, f"space-{number}")
            shown.save(out / f"space-{number}.png")
            now = Shape(shown)
            proof.check(f"a push {what}", holds(now), f"before {vars(first)}, after {vars(now)}")
            before = traced(guest, "rests")
            press(mouse, 1)
            proof.check("    and button 1 fits the view: the picture of before, bit for bit", rested(guest, before, "fit").bytes == rest.bytes)

        # Moving the selection.
        session(guest, f"""edit '{{"edit":"select","expr":"{SELECTED[0]}-{SELECTED[-1]}"}}'""")
        settled(guest, "space-selected", quiet=8)
        before = positions(fetch(guest, DECK))
        # A push that comes with the button's press would still be meant for the view.
        before_mode = traced(guest, "space mouse move")
        press(mouse, 2)
        wait_for_trace(guest, "space mouse move", before_mode)
        settled(guest, "space-mode", quiet=8)
        push(guest, mouse, f"send 01 {words(220, 0, 0)}", "space-moved", "space mouse takes")
        guest.wait_until("prismesh session --runtime-dir /run/prismesh state | grep -qE '^unsaved edits'", 120)
        session(guest, "save", limit=120)
        after = positions(fetch(guest, DECK))
        ways = [[after[node][axis] - before[node][axis] for axis in range(3)] for node in before]
        proof.check("in the other mode a push moves all selected nodes", len(ways) == len(SELECTED) and all(max(map(abs, way)) > 1e-3 for way in ways), str(ways[:3]))
        moved = state(guest)
        # The plug is pulled while the cap is pushed.
        settled(guest, "space-moved", quiet=8)
        drawn_while(guest, mouse, f"send 01 {words(0, 0, 220)}", "space mouse takes")
        mouse.do("unplug")
        guest.wait_until("! ls -l /proc/$(systemctl show -P MainPID prismesh-kiosk)/fd | grep -q /dev/hidraw", 120)
        settled(guest, "space-gone", quiet=8)
        proof.check("unplugged in the middle of a move, it is closed and the selection goes back", state(guest) == moved, state(guest))

        before_mode = traced(guest, "space mouse move")
        mouse.do("plug")
        guest.wait_until("ls -l /proc/$(systemctl show -P MainPID prismesh-kiosk)/fd | grep -q /dev/hidraw", 120)
        wait_for_trace(guest, "space mouse move", before_mode)
        proof.check("plugged in again, it is opened again", True)
        settled(guest, "space-back", quiet=8)
        push(guest, mouse, f"send 01 {words(-220, 0, 0)}", "space-again", "space mouse takes")
        guest.wait_until("systemctl is-active --quiet prismesh-kiosk", 10)
        again = state(guest)
        proof.check("and moves the selection again", again != moved, again)
        said = guest.run("journalctl -b -o cat --no-pager -u prismesh-kiosk | grep 'space mouse'", check=False)[1]
        proof.check("the kiosk traces what the device did: three moves begun, four fits", said.count("takes") == 3 and said.count("space mouse fits") == 4, said)
        proof.check("it was never started again", guest.run("systemctl show -P NRestarts prismesh-kiosk").strip() == "0")
        # The kernel also makes an input device of it, which libinput sees.
        said = guest.run("grep -A5 SpaceNavigator /proc/bus/input/devices; journalctl -b -o cat --no-pager -u prismesh-kiosk | grep '^rests'", check=False)[1]
        proof.check("and took none of it for a mouse", "Handlers=" in said and set(re.findall("^rests .*", said, re.M)) == {"rests presses 0 releases 0 pointer none"}, said)
    finally:
        mouse.end()


# --- Falcon ---

def pen(guest):
    return guest.run("prismesh devices --runtime-dir /run/prismesh", check=False, limit=180)[1]


def wait_for_pen(guest, what, limit):
    end = time.time() + limit
    while not re.search(what, said := pen(guest), re.S):
        if time.time() > end:
            raise Gone(f"the pen doesn't come to {what!r} within {limit} s:\n{said}")
        time.sleep(1)
    return said


def falcon(proof, guest, programs, out):
    guest.wait_until("[ $(systemctl is-active multi-user.target) = active ]", 300)
    guest.run("systemctl stop prismesh-kiosk", limit=180)
    device = UsbDevice(programs, "falcon", socket_path(out, "falcon"))
    try:
        said = wait_for_pen(guest, "there is no such device", 180)
        proof.check("without the Falcon the service says that there is none", True, said)
        for time_of in ("first", "second"):
            device.do("pump")
            device.do("plug")
            find = "(cd /sys/bus/usb/devices; for d in *; do [ \"$(cat $d/idProduct 2>/dev/null)\" != cb48 ] || sed -n 's,^DEVNAME=,/dev/,p' $d/uevent; done)"
            guest.wait_until(f"{find} | grep -q /dev/", 180)
            node = guest.run(find).strip()
            guest.wait_until(f"udevadm settle; [ \"$(stat -c '%U:%G %a' {node})\" = 'root:prismesh 660' ]", 180)
            proof.check(f"the {time_of} time the udev rule opens the Falcon to the group prismesh", True)
            end = time.time() + 600
            while (now := device.state())["homed"] != "7" or now["runs"] != "1":
                if time.time() > end:
                    raise Gone(f"the Falcon doesn't get so far: {now}\n{pen(guest)}")
                time.sleep(1)
            proof.check("    the service loads the firmware, each byte as in the file, and a hand homes it", now["loaded"] == "1", str(now))
            # The guard may just have taken the line of a loop that was late; then the service opens the device anew.
            openers = f"find /proc/[0-9]*/fd -lname {node} 2>/dev/null"
            guest.wait_until(f"{openers} | grep -q .", 300)
            users = guest.run(f"{openers} | cut -d/ -f1-3 | xargs -r stat -c %U 2>/dev/null", check=False, limit=180)[1].split()
            proof.check("    the device is open by the service's user only", set(users) == {"prismesh-deviced"}, str(users))
            device.do("rest")
            said = wait_for_pen(guest, r"at \((9|10|11)\.\d, -(19|20|21)\.\d, [456]\.\d\) mm", 300)
            proof.check("    the pose of the grip arrives, along its own axes: 10 to the right, 20 down, 5 toward the user", True, said)
            proof.check("    and nobody has armed it: no force was ever sent", device.state()["forces"] == "0", str(device.state()))
            if time_of == "first":
                print("    " + pen(guest).strip().replace("\n", "\n    "))
                device.do("unplug")
                said = wait_for_pen(guest, "there is no such device", 180)
                proof.check("unplugged, the service says so and goes on", guest.run("systemctl is-active prismesh-pen", check=False)[1].strip() == "active", said)
    finally:
        device.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("image")
    parser.add_argument("--programs", required=True, help="folder of vm_usb_device")
    parser.add_argument("--out", required=True)
    parser.add_argument("--only", choices=("space-mouse", "falcon"))
    arguments = parser.parse_args()
    out = pathlib.Path(arguments.out).absolute()
    out.mkdir(parents=True, exist_ok=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the machine ends too
    proof, began, guest = Proof(), time.time(), None
    firmware = out / "falcon.bin"
    try:
        disk = str(out / "usb.img")
        more = []
        for kind in ("space-mouse", "falcon"):
            pathlib.Path(socket_path(out, kind)).unlink(missing_ok=True)
            more += port(out, kind)
        subprocess.run([f"{arguments.programs}/vm_usb_device", "firmware", firmware], check=True)
        patience = {f"/etc/systemd/system/prismesh-{name}.service.d/patience.conf": PATIENCE for name in ("modeld", "deviced", "kiosk", "pen")}
        prepare(arguments.image, disk, {**AGENT, **patience, "/etc/prismesh/prismesh.toml": SETTINGS, "/etc/prismesh/falcon.bin": firmware.read_bytes(),
                                        **({"/etc/systemd/system/prismesh-kiosk.service": "-> /dev/null"} if arguments.only == "falcon" else
                                           {"/etc/systemd/system/prismesh-kiosk.service.d/eyes.conf": KIOSK})})
        guest = machine(out, disk, "usb", more=more)
        guest.wait_for_shell()
        for name, part in (("space-mouse", space_mouse), ("falcon", falcon)):
            if arguments.only in (None, name):
                part(proof, guest, arguments.programs, out)
        guest.power_off(180)
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
    print(f"{time.time() - began:.0f} s; pictures and the console are in {out}")
    print("all is well" if proof.failed == 0 else f"{proof.failed} checks failed")
    return 1 if proof.failed else 0


if __name__ == "__main__":
    sys.exit(main())
