#!/usr/bin/env python3
"""Tests what `./station image` made, without starting it: a second build has the same bytes, and a changed byte of the root is refused.
Usage: image_test.py build/image build/packages [KEYS]. Needs root and SOURCE_DATE_EPOCH; some minutes. What can't run has failed."""
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading

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
# The container's own cable, with a DHCP server at its other end.
CABLE, HERE, OFFERED, CLOCK = "ve-prismesh", "192.0.2.1", "192.0.2.77", "192.0.2.9"
PROBE = """[Unit]
After=prismesh.target
[Service]
ExecStart=/bin/sh -c "/bin/bash /mnt/probe.sh >/mnt/said 2>&1; systemctl poweroff"
"""


def health(root, folder):
    """Starts the root in a container, with a kiosk that draws without a screen, and tries the health check on planted illnesses."""
    units = root / "etc/systemd/system"
    (units / "prismesh-kiosk.service.d").mkdir()
    (units / "prismesh-kiosk.service.d/headless.conf").write_text(HEADLESS)
    (units / "probe.service").write_text(PROBE)
    (units / "multi-user.target.wants/probe.service").symlink_to("../probe.service")
    said = started(root, folder, "health.sh", ["--private-network"])
    check("the health check was tried in a container", len(re.findall("^ok: ", said, re.M)) == 6 and "FAILED" not in said)


def started(root, folder, script, options):
    """Starts the root in a container, where the script runs once the station does; returns what the script said."""
    folder.mkdir()
    shutil.copy(pathlib.Path(__file__).parent / script, folder / "probe.sh")
    subprocess.run(["timeout", "-k", "5", "300", "systemd-nspawn", "-q", "-D", root, "--volatile=overlay", "--register=no", "--keep-unit", *options,
                    "--console=pipe", f"--bind={folder}:/mnt", "-b", "systemd.show_status=0"], stdin=subprocess.DEVNULL, capture_output=True)
    said = (folder / "said").read_text() if (folder / "said").exists() else ""
    print(said, end="", flush=True)
    return said


class Dhcp(threading.Thread):
    """Brings this end of the cable up and offers one address there."""
    def __init__(self):
        super().__init__(daemon=True)
        self.ended = threading.Event()

    def run(self):
        while not pathlib.Path(f"/sys/class/net/{CABLE}").exists():
            if self.ended.wait(0.05):
                return
        for command in (f"address add {HERE}/24 dev {CABLE}", f"link set {CABLE} up"):
            subprocess.run(["ip", *command.split()], check=True)
        link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        link.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, CABLE.encode())
        link.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        link.bind(("0.0.0.0", 67))
        link.settimeout(0.2)
        while not self.ended.is_set():
            try:
                asked = link.recv(2048)
            except TimeoutError:
                continue
            except OSError:
                return  # the cable is gone
            # RFC 2131: the options begin behind 236 bytes and a mark; 53 is the kind of message, 1 a search, 3 a request.
            kinds = {1: 2, 3: 5}
            at, kind = 240, 0
            while at + 1 < len(asked) and asked[at] != 255:
                if asked[at] == 53:
                    kind = asked[at + 2]
                at += 2 + asked[at + 1] if asked[at] else 1
            if kind not in kinds:
                continue
            options = bytes([53, 1, kinds[kind]])
            for option, value in ((54, HERE), (1, "255.255.255.0"), (3, HERE), (42, CLOCK)):
                options += bytes([option, 4]) + socket.inet_aton(value)
            options += bytes([51, 4, 0, 0, 14, 16, 255])
            answer = b"\x02\x01\x06\x00" + asked[4:8] + bytes(2) + asked[10:12] + bytes(4) + socket.inet_aton(OFFERED) + socket.inet_aton(HERE) + bytes(4) + asked[28:44]
            link.sendto(answer + bytes(236 - len(answer)) + b"\x63\x82\x53\x63" + options, ("255.255.255.255", 68))


def network(root, folder):
    """Starts the root once more, with a site's wrong network settings and faulty firewall, on a network that has DHCP."""
    (root / "etc/systemd/network").mkdir(exist_ok=True)
    (root / "etc/systemd/network/10-site.network").write_text("[Match]\nName=host0\n[Network]\nAddress=198.51.100.5/24\nGateway=198.51.100.1\n")
    (root / "etc/nftables.conf").write_text("table inet station { chain input { typo } }\n")
    script = root / "usr/lib/prismesh/network"
    script.write_text(script.read_text().replace("patience=60", "patience=6"))
    server = Dhcp()
    server.start()
    said = started(root, folder, "network.sh", ["--network-veth", "--machine=prismesh"])
    server.ended.set()
    server.join()
    check("network settings and firewall were tried in a container", len(re.findall("^ok: ", said, re.M)) == 12 and "FAILED" not in said)


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
        health(again / "root", again / "health")
        network(again / "root", again / "network")
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
