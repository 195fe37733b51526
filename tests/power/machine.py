"""A machine whose plug can be pulled: user-mode Linux with the host's files as its root, read-only, and an ext4 of its own on a disk image.

Killing it loses what its kernel hasn't written to the image. The image itself is a file of the host and keeps whatever was written, in the order
in which it was written: a disk without a write cache. What a disk with a cache may lose is tried from a record of its writes (write_log.py)."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
DISK_BYTES = 64 << 20


KERNEL = "linux.uml"


def missing():
    """The Debian package that isn't installed, or None."""
    search = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    wanted = {KERNEL: "user-mode-linux", "mke2fs": "e2fsprogs", "e2fsck": "e2fsprogs", "debugfs": "e2fsprogs"}
    return next((package for program, package in wanted.items() if not shutil.which(program, path=search)), None)


RUNNING = set()


def end_with_this_program():
    """A machine's processes are a group of their own, which outlives a program that is interrupted or told to end."""

    def end(number, _):
        for each in list(RUNNING):
            each.pull_the_plug()
        os._exit(128 + number)

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, end)


def memory_folder():
    """Where disks and the guest's memory lie: in memory if there is room and programs may run from there, as a guest's do; else with temporary files."""
    try:
        room = os.statvfs("/dev/shm")
        if room.f_bavail * room.f_frsize > 1 << 30 and not room.f_flag & os.ST_NOEXEC and os.access("/dev/shm", os.W_OK):
            return "/dev/shm"
    except OSError:
        pass
    return tempfile.gettempdir()


def make_disk(image, content, features=()):
    """An ext4 with a folder's content. Needs no rights. The journal is the smallest, so that it wraps around often."""
    with open(image, "wb") as file:
        file.truncate(DISK_BYTES)
    subprocess.run(["mke2fs", "-q", "-F", "-t", "ext4", "-b", "4096", "-J", "size=4", "-E", "lazy_itable_init=0,lazy_journal_init=0,root_owner=0:0",
                    *(["-O", ",".join(features)] if features else []), "-d", str(content), str(image)], check=True, capture_output=True)


def check_disk(image):
    """Replays ext4's journal, in place; then nothing may be left to repair. Returns what is wrong."""
    subprocess.run(["e2fsck", "-fy", "-E", "journal_only", str(image)], capture_output=True)
    said = subprocess.run(["e2fsck", "-fn", str(image)], capture_output=True, text=True)
    return [] if said.returncode == 0 else [f"e2fsck finds errors:\n{said.stdout}"]


def take_out(image, folder):
    """Copies what the image holds into the folder, without a kernel that knows ext4."""
    for each in pathlib.Path(folder).iterdir():
        shutil.rmtree(each)
    said = subprocess.run(["debugfs", "-R", f"rdump /deck /state /copies {folder}", str(image)], capture_output=True, text=True)
    if said.returncode != 0:
        raise RuntimeError(said.stderr)


class Machine:
    def __init__(self, work, settings, disks, memory_mb=192):
        """work: its folder, where ledger and console are. settings: for guest.py. disks: images."""
        self.work = pathlib.Path(work)
        (self.work / "guest.json").write_text(json.dumps({**settings, "work": str(self.work)}))
        (self.work / "out" / settings["name"]).mkdir(parents=True, exist_ok=True)
        self.console = open(self.work / "console", "wb")
        self.process = subprocess.Popen(
            [KERNEL, f"mem={memory_mb}M", f"uml_dir={self.work}/", "umid=machine", "root=/dev/root", "rootfstype=hostfs", "rootflags=/", "ro", "quiet", "con=null",
             "con0=null,fd:1", "panic=-1", *(f"ubd{number}={disk}" for number, disk in enumerate(disks)), f"init={HERE / 'guest.py'}", "--",
             str(self.work / "guest.json")],
            stdin=subprocess.DEVNULL, stdout=self.console, stderr=subprocess.STDOUT, start_new_session=True,
            env={**os.environ, "TMPDIR": memory_folder()})
        RUNNING.add(self)

    def pull_the_plug(self):
        """All of its processes, which are a group of their own."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()
        RUNNING.discard(self)
        self.console.close()

    def said(self):
        return (self.work / "console").read_text(errors="replace")
