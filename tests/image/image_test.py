#!/usr/bin/env python3
"""Tests what `./station image` made, without starting it: a second build has the same bytes, and a changed byte of the root is refused.
Usage: image_test.py build/image build/packages [KEYS]. Needs root and SOURCE_DATE_EPOCH; some minutes. What can't run has failed."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parents[2]
failed = 0


def check(what, holds, why=""):
    global failed
    failed += 0 if holds else 1
    print(("ok: " if holds else "FAILED: ") + what + (f"\n    {why}" if why and not holds else ""), flush=True)


def verify(image, tree, root_hash):
    """The root's every block, against its hash tree, by a program that doesn't need the kernel."""
    return subprocess.run(["veritysetup", "verify", str(image), str(image), root_hash, f"--hash-offset={tree}"], capture_output=True, text=True)


HEADLESS = """[Service]
ExecStart=
ExecStart=/usr/bin/prismesh-kiosk --runtime-dir /run/prismesh --size 640x480 --headless-frames 100000 --pace 0.2 --shots /var/lib/prismesh-kiosk
WatchdogSec=60
"""
PROBE = """[Unit]
After=prismesh.target
[Service]
ExecStart=/bin/sh -c "/bin/bash /mnt/health.sh >/mnt/said 2>&1; systemctl poweroff"
"""


def health(root, folder):
    """Starts the root in a container, with a kiosk that draws without a screen, and tries the health check on planted illnesses."""
    units = root / "etc/systemd/system"
    (units / "prismesh-kiosk.service.d").mkdir()
    (units / "prismesh-kiosk.service.d/headless.conf").write_text(HEADLESS)
    (units / "probe.service").write_text(PROBE)
    (units / "multi-user.target.wants/probe.service").symlink_to("../probe.service")
    folder.mkdir()
    shutil.copy(pathlib.Path(__file__).parent / "health.sh", folder)
    subprocess.run(["timeout", "-k", "5", "300", "systemd-nspawn", "-q", "-D", root, "--volatile=overlay", "--register=no", "--keep-unit", "--private-network",
                    "--console=pipe", f"--bind={folder}:/mnt", "-b", "systemd.show_status=0"], stdin=subprocess.DEVNULL, capture_output=True)
    said = (folder / "said").read_text() if (folder / "said").exists() else ""
    print(said, end="")
    check("the health check was tried in a container", len(re.findall("^ok: ", said, re.M)) == 6 and "FAILED" not in said)


def main():
    image = pathlib.Path(sys.argv[1]).absolute()
    packages = pathlib.Path(sys.argv[2]).absolute()
    keys = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else os.environ.get("PRISMESH_KEYS", image / "keys")).absolute()
    sealed = image / "sealed"
    root_hash, tree = (sealed / "root.hash").read_text().split()
    version = re.search(r"prismesh-(.*)\.raucb", next(iter(image.glob("*.raucb"))).name)[1]
    with tempfile.TemporaryDirectory(dir=image) as folder:
        again = pathlib.Path(folder)
        script = PROJECT / "scripts/image"
        subprocess.run([script / "tree.sh", image / "base.tar", packages, version, keys, again / "root"], check=True)
        said = subprocess.run([sys.executable, PROJECT / "tests/image/audit.py", again / "root", script / "allowed.txt"], capture_output=True, text=True)
        check("the root has what the list allows, and nothing else", said.returncode == 0, said.stdout)
        subprocess.run([script / "seal.sh", again / "root", keys, again / "sealed"], check=True)
        for name in ("root.img", "prismesh.unsigned.efi"):
            same = subprocess.run(["cmp", sealed / name, again / "sealed" / name], capture_output=True, text=True)
            check(f"built again from the same packages, {name} has the same bytes", same.returncode == 0, same.stdout)
        health(again / "root", again / "mnt")
    check("the root fits its hash", verify(sealed / "root.img", tree, root_hash).returncode == 0)
    with tempfile.TemporaryDirectory(dir=image) as folder:
        broken = pathlib.Path(folder) / "root.img"
        for name, at in (("first byte", 0), ("byte in the middle", int(tree) // 2), ("byte of the hash tree", None)):
            shutil.copyfile(sealed / "root.img", broken)
            with open(broken, "r+b") as file:
                file.seek(at if at is not None else int(tree) + 4096)  # behind the superblock
                byte = file.read(1)
                file.seek(-1, os.SEEK_CUR)
                file.write(bytes([byte[0] ^ 1]))
            said = verify(broken, tree, root_hash)
            check(f"with another {name} it is refused", said.returncode != 0, said.stdout)
    shown = subprocess.run(["rauc", f"--keyring={keys}/update-ca.crt", "info", str(image / f"prismesh-{version}.raucb")], capture_output=True, text=True)
    check("the update's signature is good, and it is for stations", shown.returncode == 0 and "prismesh-station" in shown.stdout, shown.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
