#!/usr/bin/env python3
"""Updates a station in an emulated machine: a good version is taken, an ill one is given up with its reason, a wrong signature and an older version
are refused, and a power cut in the middle changes nothing that runs. Then the first start
of two new stations, what a damaged disk leads to, and Secure Boot with the image's own keys. `./station vm` runs it.

Usage: update.py build/image --out out/vm [--only updates|first|refusals|secure]. Needs root and SOURCE_DATE_EPOCH. Each line is "ok: .." or "FAILED: ..".

The versions are made of the image's own root: same files, another version, packed faster; the ill one has a document daemon that ends at once.
Their kernels get two more words, so that the console is on the serial port and the emulation is faster. Everything else is the image's."""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

from machine import Gone, Machine
from run import HERE, PATIENCE, SIZE, Picture, Proof, partition, prepare

SCRIPTS = HERE.parents[1] / "scripts/image"
ARGUMENTS = "console=tty0 console=ttyS0 mitigations=off"
HEALTH = "patience=120\nlate_percent=90\n"  # the emulation is late; that the figure is read is tested, not its size
CUTS = 1


def run(*command, **options):
    return subprocess.run([str(each) for each in command], check=True, **options)


class Versions:
    """Sealed roots, kernels and bundles, made of what `./station image` sealed."""
    def __init__(self, image, out):
        self.image, self.out = image, out
        self.keys = pathlib.Path(os.environ.get("PRISMESH_KEYS", image / "keys"))
        self.tree, self.boot = out / "tree", out / "tree.boot"
        self.is_unpacked = False

    def unpack(self):
        image, out = self.image, self.out
        shutil.rmtree(self.tree, ignore_errors=True)
        run("unsquashfs", "-quiet", "-no-progress", "-d", self.tree, image / "sealed/root.img", stdout=subprocess.DEVNULL)
        shutil.rmtree(self.boot, ignore_errors=True)
        shutil.copytree(image / "sealed/boot", self.boot)
        self.is_unpacked = True

    def seal(self, version, change=None):
        """change: by path, the text of files that are others in this version. Returns the folder."""
        if not self.is_unpacked:
            self.unpack()
        release = self.tree / "usr/lib/os-release"
        release.write_text(re.sub(r"IMAGE_VERSION=.*", f"IMAGE_VERSION={version}", release.read_text()))
        kept = {}
        for path, text in (change or {}).items():
            kept[path] = (self.tree / path).read_bytes()
            (self.tree / path).write_text(text)
        sealed = self.out / f"sealed-{version}"
        run(SCRIPTS / "seal.sh", self.tree, self.keys, sealed, env={**os.environ, "PRISMESH_COMPRESSION": "1", "PRISMESH_BOOT_ARGUMENTS": ARGUMENTS})
        for path, data in kept.items():
            (self.tree / path).write_bytes(data)
        return sealed

    def bundle(self, sealed, version, folder, name=None, keys=None):
        run(SCRIPTS / "bundle.sh", sealed, version, keys or self.keys, folder / f"{name or version}.raucb")


def firmware(out, secure=False):
    """QEMU's arguments for the firmware, whose variables last from start to start of a machine."""
    variables = out / ("secure.vars" if secure else "plain.vars")
    if not variables.exists():
        shutil.copy("/usr/share/OVMF/OVMF_VARS_4M.fd", variables)
    code = "/usr/share/OVMF/OVMF_CODE_4M.secboot.fd" if secure else "/usr/share/OVMF/OVMF_CODE_4M.fd"
    protect = ["-machine", "smm=on", "-global", "driver=cfi.pflash01,property=secure,value=on"] if secure else []
    return [*protect, "-drive", f"if=pflash,format=raw,readonly=on,file={code}", "-drive", f"if=pflash,format=raw,file={variables}"]


class Station:
    def __init__(self, out, disk, updates):
        self.out, self.disk, self.updates, self.starts, self.guest = out, disk, updates, 0, None

    def start(self, secure=False):
        self.starts += 1
        console = open(self.out / f"update-{self.starts}.console", "w")
        boot = firmware(self.out, secure)
        if self.updates:
            boot += ["-drive", f"file={self.updates},format=raw,if=virtio,readonly=on"]
        self.guest = Machine(self.out, self.disk, boot=boot, size=SIZE, snapshot=False, processors=1,
                             log=lambda text: print(text, file=console, flush=True))
        return self.guest

    def ready(self, limit=900):
        self.guest.wait_for_shell(limit)
        return self.guest

    def ended(self, limit):
        """Waits until the machine has restarted: QEMU ends then."""
        try:
            self.guest.process.wait(limit)
            return True
        except subprocess.TimeoutExpired:
            return False

    def status(self):
        return self.guest.run("prismesh-update status", limit=180)

    def install(self, name, limit=1800):
        self.guest.run("mkdir -p /run/updates; mountpoint -q /run/updates || mount -o ro /dev/disk/by-label/updates /run/updates")
        return self.guest.run(f"prismesh-update install /run/updates/{name}.raucb 2>&1", limit=limit, check=False)

    def restart(self):
        self.guest.run("systemctl --no-block reboot")
        if not self.ended(300):
            raise Gone("the machine doesn't restart")

    def kill(self):
        if self.guest and self.guest.process.poll() is None:
            self.guest.kill()


def disk_of_updates(folder, path):
    size = sum(each.stat().st_size for each in folder.iterdir()) // 1024 + 65536
    path.unlink(missing_ok=True)
    run("mke2fs", "-q", "-F", "-t", "ext4", "-L", "updates", "-O", "^has_journal", "-d", folder, path, f"{size}k")


def locked_down(proof, guest):
    """What the built tree promises, in the machine that runs."""
    said = guest.run("findmnt -no FSTYPE,OPTIONS /; veritysetup status prismesh-root | grep -E 'status|type'", check=False)[1]
    proof.check("the root is a squashfs, and its blocks are verified", "squashfs ro" in said and "verified" in said, said)
    proof.check("programs can't be changed", guest.run("touch /usr/bin/x", check=False)[0] != 0)
    said = guest.run("cat /etc/machine-id; hostname 2>/dev/null || cat /proc/sys/kernel/hostname").split()
    proof.check("the machine has given itself a number and a name", len(said) == 2 and len(said[0]) == 32 and said[1] == f"prismesh-{said[0][:4]}", str(said))
    proof.check("no key reaches the kernel", guest.run("cat /proc/sys/kernel/sysrq").strip() == "0")
    # Activates the second console, as Ctrl+Alt+F2 does.
    other = """perl -e 'open(C, "+<", "/dev/tty0"); exit(ioctl(C, 0x5606, 2) ? 1 : 0)'; cat /sys/class/tty/tty0/active"""
    status, said = guest.run(other, check=False)
    proof.check("the console can't be changed, even by root", said.strip().endswith("tty1"), said)
    proof.check("no login runs", guest.run("systemctl list-units --no-legend '*getty*' 'ssh*' 'sshd*' --state=active,activating").strip() == "")
    proof.check("USB storage has no driver", guest.run("modprobe usb_storage 2>/dev/null; grep -c '^usb_storage' /proc/modules", check=False)[1].strip() == "0")
    guest.run("touch /etc/prismesh/allow-usb-storage; modprobe usb_storage")
    proof.check("unless the settings allow it", guest.run("grep -c '^usb_storage' /proc/modules", check=False)[1].strip() == "1")
    guest.run("rm /etc/prismesh/allow-usb-storage; rmmod usb_storage")
    rules = guest.run("nft list chain inet station input")
    proof.check("the firewall drops what it doesn't name", "policy drop" in rules, rules)
    ports = guest.run("cat /proc/net/tcp /proc/net/tcp6 | awk '$4 == \"0A\" { print $2 }'").split()
    proof.check("no port of TCP is open", ports == [], str(ports))


def updates(proof, versions, out):
    work = out / "bundles"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    first = versions.seal("1.0")
    disk = out / "update.img"
    versions.bundle(first, "0.9", work)
    run(SCRIPTS / "disk.sh", first, "1.0", versions.keys, out / "first.img")
    good = versions.seal("1.1")
    versions.bundle(good, "1.1", work)
    versions.bundle(good, "1.1", work, name="stranger", keys=out / "other")
    ill = versions.seal("1.2", {"usr/bin/prismesh-modeld": "#!/bin/sh\necho 'planted: the document daemon ends at once' >&2\nexit 1\n"})
    versions.bundle(ill, "1.2", work)
    disk_of_updates(work, out / "updates.img")
    files = {"/var/lib/test/agent.sh": (HERE / "agent.sh").read_text(), "/etc/systemd/system/agent.service": (HERE / "agent.service").read_text(),
             "/etc/systemd/system/multi-user.target.wants/agent.service": "-> ../agent.service", "/etc/prismesh/health.conf": HEALTH}
    for name in ("modeld", "deviced", "kiosk", "pen"):
        files[f"/etc/systemd/system/prismesh-{name}.service.d/patience.conf"] = PATIENCE
    prepare(out / "first.img", disk, files)
    (out / "plain.vars").unlink(missing_ok=True)
    station = Station(out, disk, out / "updates.img")
    try:
        station.start()
        guest = station.ready()
        proof.check(f"version 1.0 runs, after {guest.seconds():.0f} s", "version 1.0 runs from slot A" in station.status(), station.status())
        locked_down(proof, guest)

        status, said = station.install("stranger")
        proof.check("an update that somebody else signed is refused", status != 0 and "signature" in said.lower(), said)
        status, said = station.install("0.9")
        proof.check("an older version is refused, with the reason", status != 0 and "0.9 isn't newer than 1.0" in said, said)
        proof.check("after that slot A is as it was", "slot A: version 1.0, confirmed" in station.status(), station.status())

        for cut in range(CUTS):
            # The plug is pulled while the other slot is being written; each time a little later.
            guest.run("mkdir -p /run/updates; mountpoint -q /run/updates || mount -o ro /dev/disk/by-label/updates /run/updates")
            guest.run("(prismesh-update install /run/updates/1.1.raucb >/run/install.log 2>&1) & true")
            guest.wait_until("grep -q 'Copying image to rootfs' /run/install.log", 300)
            time.sleep(1 + 5 * cut)
            log = guest.run("tail -n 3 /run/install.log")
            guest.kill()
            station.start()
            guest = station.ready()
            said = station.status()
            proof.check("a power cut while the other slot is written leaves what ran", "version 1.0 runs from slot A" in said and "slot B" not in said, said + log)

        began = time.time()
        status, said = station.install("1.1")
        proof.check(f"a good update is taken, in {time.time() - began:.0f} s", status == 0, said)
        proof.check("it is on trial", "slot B: version 1.1, trial" in station.status(), station.status())
        station.restart()
        station.start()
        guest = station.ready()
        proof.check("the new version runs from the other slot", "version 1.1 runs from slot B" in station.status(), station.status())
        guest.wait_until("! systemctl is-active --quiet prismesh-update-confirm && systemctl show -P Result prismesh-update-confirm && prismesh-update status | grep -q 'slot B: version 1.1, confirmed'", 1500)
        proof.check("it was confirmed by its health check", True)
        print("    " + guest.run("journalctl -b -o cat --no-pager -u prismesh-update-confirm | grep confirmed").strip())

        status, said = station.install("1.2")
        proof.check("the ill version's bundle is good by itself", status == 0, said)
        station.restart()
        station.start()
        proof.check("the ill version gives itself up and restarts the machine", station.ended(2400))
        station.start()
        guest = station.ready()
        said = station.status()
        proof.check("the version before runs again", "version 1.1 runs from slot B" in said and "slot A: version 1.2, bad" in said, said)
        proof.check("and says why", re.search(r"Version 1.2 was given up: prismesh-modeld doesn't run; it says: .*", said) is not None, said)
        shown = guest.run("journalctl -b -o cat --no-pager -u prismesh-notice")
        proof.check("the reason was on the screen before the kiosk", "Version 1.2 was given up" in shown, shown)
        guest.run("fallocate -l $(($(df --output=avail -B1 /data | tail -n 1) - 1000000)) /data/full")
        said = guest.run("/usr/lib/prismesh/update/notice; rm /data/full", limit=120)
        proof.check("a full disk is named on the screen", "The disk for models is full" in said, said)
        guest.power_off(300)
    finally:
        station.kill()


def first_start(proof, versions, out):
    """The image as it is written to a larger disk, with its empty data partition: it sets itself up."""
    sealed = out / "sealed-1.0"
    if not sealed.exists():
        versions.seal("1.0")
    run(SCRIPTS / "disk.sh", sealed, "1.0", versions.keys, out / "new.img")
    (out / "plain.vars").unlink(missing_ok=True)
    made = []
    for number in range(2):
        disk = out / f"new-{number}.img"
        run("cp", "--sparse=always", out / "new.img", disk)
        run("truncate", "-s", "+1G", disk)
        if number == 1:  # as after a power cut while the file system was made: mke2fs has removed the mark at the head
            run("sfdisk", "--quiet", "-N", "4", disk, input=", +", text=True)
            at, size = partition(disk, "prismesh-data")
            with open(disk, "r+b") as file:
                file.seek(at)
                file.write(bytes(65536))
                file.seek(at + size // 4096 * 4096 - 4096)
                file.write(b"prismesh: empty data partition\n")
        station = Station(out, disk, None)
        station.starts = 80 + number
        guest = station.start()
        try:
            end = time.time() + 900
            while guest.process.poll() is None and time.time() < end:
                time.sleep(20)  # the button is heard as soon as the machine listens to it; the station has its identity by then
                if guest.process.poll() is None:
                    guest.command("system_powerdown")
            proof.check("a new station starts, and stops by its button", guest.process.poll() is not None, "".join(guest.console_text)[-1500:])
        finally:
            station.kill()
        at, size = partition(disk, "prismesh-data")
        with open(disk, "rb") as file:
            file.seek(at + 1024)
            block = file.read(64)
        blocks, block_size = int.from_bytes(block[4:8], "little"), 1024 << int.from_bytes(block[24:28], "little")
        proof.check(f"and its file system the whole partition: {blocks * block_size >> 20} MB", blocks * block_size >= size - 2 * block_size, str(size))
        proof.check(f"its data partition has taken the rest of the disk: {size >> 20} MB", size > partition(out / "new.img", "prismesh-data")[1] + (1 << 30) - (4 << 20), str(size))

        def text(name):
            return run("debugfs", "-R", f"cat {name}", f"{disk}?offset={at}", capture_output=True, text=True).stdout.strip()
        made.append((text("etc/machine-id"), text("etc/hostname")))
        said = run("debugfs", "-R", "stat etc/prismesh/set-up-due", f"{disk}?offset={at}", capture_output=True, text=True).stdout
        proof.check("its set-up is due", "Type: regular" in said, said)
        proof.check("it has a number and a name of its own", len(made[-1][0]) == 32 and made[-1][1] == f"prismesh-{made[-1][0][:4]}", str(made))
        disk.unlink()
    proof.check("two stations of one image have different ones", made[0][0] != made[1][0], str(made))


def refusals(proof, versions, out):
    """Damage of the disk: the screen has a sentence, and the models stay as they were."""
    sealed = out / "sealed-1.0"
    if not sealed.exists():
        versions.seal("1.0")
    run(SCRIPTS / "disk.sh", sealed, "1.0", versions.keys, out / "first.img")
    disk = out / "damaged.img"
    data, size = partition(out / "first.img", "prismesh-data")
    root, _ = partition(out / "first.img", "prismesh-root-a")

    def write(at, text):
        with open(disk, "r+b") as file:
            file.seek(at)
            file.write(text)

    def data_now():
        with open(disk, "rb") as file:
            file.seek(data)
            return file.read(size)

    def newer():
        run("debugfs", "-w", "-R", "rm format", f"{disk}?offset={data}", capture_output=True)
        (out / "format").write_text("2\n")
        run("debugfs", "-w", "-R", f"write {out / 'format'} format", f"{disk}?offset={data}", capture_output=True)

    def damaged_folder():
        """The root folder's block: what e2fsck won't mend without asking."""
        said = run("debugfs", "-R", "blocks /", f"{disk}?offset={data}", capture_output=True, text=True).stdout
        write(data + 4096 * int(said.split()[0]), b"\xff" * 4096)

    cases = (("with another byte in the root", lambda: write(root, b"x"), "aren't those that were signed", False),
             ("without a data partition", lambda: run("sfdisk", "--quiet", "--delete", disk, "4"), "no partition prismesh-data", False),
             ("with a data partition whose head is zeros", lambda: write(data, bytes(8192)), "data partition is damaged", False),
             ("with a data partition whose first folder is garbage", damaged_folder, "data partition is damaged", True),
             ("with data of a newer version", newer, "written by a newer version (format 2", True))
    model = "*KEYWORD\n$ kept\n*END\n"
    for number, (what, damage, sentence, checked) in enumerate(cases):
        prepare(out / "first.img", disk, {"/var/lib/prismesh/models/kept.k": model})
        at = data_now().find(model.encode())
        damage()
        before = data_now()
        (out / "plain.vars").unlink(missing_ok=True)
        station = Station(out, disk, None)
        station.starts = 50 + number
        guest = station.start()
        try:
            end = time.time() + 300
            while time.time() < end and guest.process.poll() is None and "The station can't start" not in "".join(guest.console_text):
                time.sleep(1)
            time.sleep(3)
            said = "".join(guest.console_text)
            proof.check(f"{what} the screen says: .. {sentence} ..", sentence in said, said[-1500:])
            picture = Picture(guest.screen(f"damage-{number}"))
            picture.save(out / f"damage-{number}.png")
        finally:
            station.kill()
        # The check of a file system writes its time.
        after = data_now()
        proof.check("    and the model is as it was", after[at:at + len(model)] == model.encode() and (checked or after == before))


def secure(proof, versions, out):
    """The firmware takes the image's keys; then it starts the signed kernel, and nothing else."""
    sealed = out / "sealed-1.0"
    if not sealed.exists():
        versions.seal("1.0")
    disk = out / "secure.img"
    run(SCRIPTS / "disk.sh", sealed, "1.0", versions.keys, disk)
    boot = f"{disk}@@{partition(disk, 'prismesh-boot')[0]}"

    def put(source, name):
        run("mcopy", "-o", "-i", boot, source, f"::{name}")

    def starts(name, limit):
        """What the console says until the initial disk speaks, or a refusal, or the end."""
        station = Station(out, disk, None)
        station.starts = 100 + len(list(out.glob("update-1*.console")))
        guest = station.start(secure=True)
        end = time.time() + limit
        try:
            while time.time() < end:
                text = "".join(guest.console_text)
                if re.search(r"Setting the disk up|Loading, please wait|Starting systemd-udevd|ecurity (Policy )?[Vv]iolation|Access [Dd]enied|Error loading", text) or guest.process.poll() is not None:
                    break
                time.sleep(1)
            return "".join(guest.console_text)
        finally:
            station.kill()

    (out / "secure.vars").unlink(missing_ok=True)
    loader = out / "loader.conf"
    loader.write_text("timeout 0\neditor no\nsecure-boot-enroll force\n")
    put(loader, "loader/loader.conf")
    # systemd-boot takes keys by itself from this folder only; on a station somebody chooses them in its menu.
    run("mmd", "-i", boot, "::loader/keys/auto")
    for key in ("db", "KEK", "PK"):
        put(versions.keys / f"boot-{key}.auth", f"loader/keys/auto/{key}.auth")
    said = starts("enrol", 240)
    proof.check("the firmware takes the image's keys", "nroll" in said and "Setting the disk up" not in said, said[-2000:])
    said = starts("signed", 300)
    proof.check("the signed kernel starts", "Setting the disk up" in said, said[-2000:])
    put(sealed / "prismesh.unsigned.efi", "EFI/Linux/prismesh-1.0-A.efi")
    said = starts("unsigned", 240)
    proof.check("the same kernel without a signature is refused", re.search(r"ecurity (Policy )?[Vv]iolation|Access [Dd]enied", said) is not None and "Setting the disk up" not in said, said[-2000:])
    run("sbsign", "--key", out / "other/boot-db.key", "--cert", out / "other/boot-db.crt", "--output", out / "stranger.efi", sealed / "prismesh.unsigned.efi", stderr=subprocess.DEVNULL)
    put(out / "stranger.efi", "EFI/Linux/prismesh-1.0-A.efi")
    said = starts("stranger", 240)
    proof.check("signed by somebody else it is refused", re.search(r"ecurity (Policy )?[Vv]iolation|Access [Dd]enied", said) is not None and "Setting the disk up" not in said, said[-2000:])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("image")
    parser.add_argument("--out", required=True)
    parser.add_argument("--only", choices=("updates", "first", "refusals", "secure"))
    arguments = parser.parse_args()
    out = pathlib.Path(arguments.out).absolute()
    out.mkdir(parents=True, exist_ok=True)
    proof, began = Proof(), time.time()
    try:
        versions = Versions(pathlib.Path(arguments.image).absolute(), out)
        if not (out / "other").exists():
            run(SCRIPTS / "keys.sh", out / "other")
        for name, part in (("updates", updates), ("first", first_start), ("refusals", refusals), ("secure", secure)):
            if arguments.only in (None, name):
                part(proof, versions, out)
    except Gone as problem:
        proof.check("the machine did as it was asked", False, str(problem))
    print(f"{time.time() - began:.0f} s; consoles are in {out}")
    print("all is well" if proof.failed == 0 else f"{proof.failed} checks failed")
    return 1 if proof.failed else 0


if __name__ == "__main__":
    sys.exit(main())
