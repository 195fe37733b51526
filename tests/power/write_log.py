"""The record of a disk's writes, and what the disk may hold by it if it has a write cache.

The guest's kernel records (dm-log-writes): each write with its data, each flush, and marks that the guest sets between them, one for each line of the
ledger. A write stands before the flush that made it durable: until then the disk may have stored it or not, in any order, also only some of its
sectors. Format: Documentation/admin-guide/device-mapper/log-writes.rst and drivers/md/dm-log-writes.c of the kernel."""
import ctypes
import dataclasses
import fcntl
import glob
import os
import random
import struct

NAME = "recorded"
DEVICE = "/dev/dm-0"
SECTOR = 512
FIRST_TORN = 8  # ext4's superblock lies before: no journal heals it if it is torn, so ext4 counts on a disk that writes 4096 bytes whole
LOG_BYTES = 512 << 20

# --- in the guest ---

CREATE, REMOVE, RESUME, LOAD, MESSAGE = 3, 4, 6, 9, 14  # commands of /dev/mapper/control
HEADER_BYTES = 312


def insert_module(name):
    path, = glob.glob(f"/usr/lib/uml/modules/{os.uname().release}/kernel/drivers/md/{name}.ko")
    with open(path, "rb") as file:
        library = ctypes.CDLL(None, use_errno=True)
        if library.syscall(313, file.fileno(), b"", 0) != 0:  # finit_module
            raise OSError(ctypes.get_errno(), f"{path}: {os.strerror(ctypes.get_errno())}")


def control(command, payload=b"", targets=0):
    size = HEADER_BYTES + len(payload)
    head = struct.pack("=3I 2I I i 3I Q 128s 129s 7x", 4, 0, 0, size, HEADER_BYTES, targets, 0, 0, 0, 0, 0, NAME.encode(), b"")
    with open("/dev/mapper/control", "rb") as file:
        fcntl.ioctl(file, 3 << 30 | HEADER_BYTES << 16 | 0xFD << 8 | command, bytearray(head + payload))


def begin(device, log):
    """Records what is written to DEVICE, which stands for `device`, onto `log`. Returns the function that sets a mark."""
    for module in ("dm-mod", "dm-log-writes"):
        insert_module(module)
    with open(device, "rb") as file:
        sectors = file.seek(0, os.SEEK_END) // SECTOR
    parameters = f"{device} {log}".encode() + b"\0"
    parameters += b"\0" * (-len(parameters) % 8)
    control(CREATE)
    control(LOAD, struct.pack("=QQiI16s", 0, sectors, 0, 40 + len(parameters), b"log-writes") + parameters, 1)
    control(RESUME)
    return lambda number: control(MESSAGE, struct.pack("=Q", 0) + f"mark {number}".encode() + b"\0")


def end():
    """All that was recorded is on the log when this returns."""
    control(REMOVE)


# --- on the host ---

MAGIC = 0x6A736677736872
FLUSH, FUA, DISCARD, MARK = 1, 2, 4, 8


@dataclasses.dataclass
class Entry:
    sector: int
    flags: int
    data: bytes  # of a mark: its text

    def writes(self):
        return bool(self.data) and not self.flags & MARK


def read_log(path):
    with open(path, "rb") as file:
        magic, version, count, size = struct.unpack("<QQQI", file.read(28))
        if magic != MAGIC or version != 1:
            raise ValueError(f"{path} is no log of dm-log-writes")
        entries = []
        file.seek(size)
        for _ in range(count):
            block = file.read(size)
            sector, sectors, flags, length = struct.unpack("<QQQQ", block[:32])
            data = block[32:32 + length] if flags & MARK else b"" if flags & DISCARD else file.read(sectors * size)
            entries.append(Entry(sector * size // SECTOR, flags, data))
        return entries


@dataclasses.dataclass
class Moment:
    """A moment at which the power may be cut: right before a flush is done."""
    durable: list  # writes since the moment before, which no cut can take any more
    open: list  # writes that the disk may have stored
    mark: int  # the last line of the ledger that was written by then


def moments(entries):
    found, window, durable, mark = [], [], [], 0
    for entry in entries:
        if entry.flags & MARK:
            text = entry.data.split(b"\0")[0]
            mark = int(text) if text.isdigit() else mark  # the kernel sets one of its own at the end
            continue
        if entry.flags & FLUSH:
            found.append(Moment(durable, list(window), mark))
            durable, window = list(window), []
        if entry.writes():
            # A forced write is durable by itself, in whichever order the others are.
            (durable if entry.flags & FUA else window).append(entry)
    found.append(Moment(durable, window, mark))
    return found


def put(file, entry, sectors=None):
    """Writes an entry, or only some of its sectors, into an image."""
    if sectors is None:
        file.seek(entry.sector * SECTOR)
        file.write(entry.data)
        return
    for number in sectors:
        file.seek((entry.sector + number) * SECTOR)
        file.write(entry.data[number * SECTOR:(number + 1) * SECTOR])


def put_by_chance(file, writes, chance):
    """What the disk has stored of these writes: none, all, the first few, some whole, some torn."""
    how = chance.choice(("none", "first", "some", "torn", "torn", "all but one"))
    if how == "none" or not writes:
        return how
    left_out = chance.randrange(len(writes))
    likely = chance.choice((0.2, 0.5, 0.8))
    for number, entry in enumerate(writes):
        if how == "first" and number >= left_out:
            break
        if how == "all but one" and number == left_out or how == "some" and chance.random() > likely:
            continue
        if how == "torn" and entry.sector >= FIRST_TORN:
            put(file, entry, [each for each in range(len(entry.data) // SECTOR) if chance.random() < likely])
        elif how != "torn" or chance.random() < likely:
            put(file, entry)
    return how
