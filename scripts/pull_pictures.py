#!/usr/bin/env python3
"""Makes the documentation's pictures of a pull: docs/pictures/pull.png, an animation (APNG), docs/pictures/kiosk.png, and
docs/pictures/quality_panel.png, which shows the first error that it leaves.

    scripts/pull_pictures.py [FOLDER]      FOLDER: where the pictures are written; default docs/pictures

Runs the programs of build/bin on an X server without a screen. The kiosk shows the sample, a scripted pointer pulls the arrow of the sill's
outer face, and each frame is copied from the screen. Needs the packages of the section [test] in packages.txt.
"""
import json
import math
import mmap
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = pathlib.Path(os.environ.get("PRISMESH_PROGRAMS", ROOT / "build" / "bin"))
WIDTH, HEIGHT = 1400, 860
SILL_FACE = [1180.0, -84.0, 0.0]
ZOOM_STEPS = 7  # of the wheel
MIDDLE = 612, 400  # where the handle is put: about the middle of the view
PULL_PIXELS = 56
STEPS = 15
STEP_MS, REST_MS = 110, 800
CROP = (212, 104, 800, 520)  # the animation's part of the view: left, top, width, height
PANEL_CROP = (400, 0, 1000, 860)  # the dock with the quality panel, and the error beside it
TIMEOUT_S = 60


class Screen:
    """An X server without a screen, whose pixels are a file."""

    def __init__(self, folder):
        command = ["Xvfb", "-displayfd", "1", "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", folder, "-nolisten", "tcp"]
        self.server = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.name = ":" + self.server.stdout.readline().strip()
        with open(folder / "Xvfb_screen0", "rb") as file:
            self.file = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)

    def pixels(self):
        """The screen's rows, each a list of 4 bytes a pixel: red, green, blue, opaque (the file is an X window dump)."""
        header = struct.unpack(">25I", self.file[:100])
        line_bytes, colours = header[12], header[19]
        start = header[0] + 12 * colours
        rows = []
        for y in range(HEIGHT):
            row = self.file[start + y * line_bytes : start + y * line_bytes + 4 * WIDTH]
            swapped = bytearray(row)
            swapped[0::4], swapped[2::4] = row[2::4], row[0::4]
            swapped[3::4] = b"\xff" * WIDTH
            rows.append(bytes(swapped))
        return rows


class Kiosk:
    """The kiosk in a window of the screen's size, and the pointer over it."""

    def __init__(self, screen, deck):
        self.environment = dict(os.environ, DISPLAY=screen.name)
        self.presses = self.releases = 0
        command = [BIN / "prismesh-kiosk", "--trace", "--size", f"{WIDTH}x{HEIGHT}", "--open", deck]
        self.process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        self.wait_for(lambda line: line.startswith("picture ") and not line.endswith("none"))
        self.xdotool("search", "--sync", "--onlyvisible", "--name", "^Prismesh$", "windowmove", "--sync", "0", "0", "windowfocus")

    def wait_for(self, wanted):
        """Reads the kiosk's trace up to a line that is `wanted`. Stores the handle's foot and tip in pixels."""
        for line in self.process.stdout:
            if line.startswith("handle ") and line != "handle none\n":
                self.handle = tuple(map(float, line.split()[1:5]))
            if wanted(line.rstrip("\n")):
                return
        raise SystemExit("pull_pictures: the kiosk ended early")

    def xdotool(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True, timeout=TIMEOUT_S, stdout=subprocess.DEVNULL)

    def move(self, x, y):
        self.xdotool("mousemove", round(x), round(y))
        self.rest(x, y)

    def zoom(self, x, y):
        """Turns the wheel at a pixel."""
        self.xdotool("click", "--repeat", ZOOM_STEPS, "--delay", 50, 4)
        self.presses += ZOOM_STEPS
        self.rest(x, y)

    def pan(self, to_x, to_y):
        self.xdotool("mousedown", 2, "mousemove", round(to_x), round(to_y), "mouseup", 2)
        self.presses += 1
        self.releases += 1
        self.rest(to_x, to_y)

    def press(self, x, y):
        self.xdotool("mousedown", 1)
        self.presses += 1
        self.rest(x, y)

    def release(self):
        self.xdotool("mouseup", 1)
        self.releases += 1
        self.wait_for(lambda line: line.startswith("drag committed"))
        self.wait_for(lambda line: line.startswith("picture "))

    def first_error(self):
        """Opens the quality panel and moves the view to the worst shell."""
        self.xdotool("key", "j")
        self.wait_for(lambda line: line.startswith("quality generation "))
        self.xdotool("key", "Right")
        self.wait_for(lambda line: line.startswith("picture "))
        time.sleep(1)  # the view moves for 0.2 s, and a kiosk that draws by software does it in few frames

    def rest(self, x, y):
        """Waits until the screen shows everything that the pointer did."""
        rests = f"rests presses {self.presses} releases {self.releases} pointer {round(x)} {round(y)}"
        self.wait_for(lambda line: line == rests)
        time.sleep(0.1)  # the X server copies the picture a moment after the kiosk has handed it over


def session(*arguments):
    """One request to the model server."""
    done = subprocess.run([BIN / "prismesh", "session", *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise SystemExit(f"pull_pictures: {done.stderr.strip()}")


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def packed(rows, pixel_bytes):
    """PNG's compressed rows: plain, or as differences from the pixels at the left or above, whichever is shortest."""
    above = [bytes(len(rows[0])), *rows]
    left = [bytes(pixel_bytes) + row for row in rows]
    forms = [
        b"".join(b"\0" + row for row in rows),
        b"".join(b"\1" + differences(row, other) for row, other in zip(rows, left)),
        b"".join(b"\2" + differences(row, other) for row, other in zip(rows, above)),
    ]
    return min((zlib.compress(form, 9) for form in forms), key=len)


def differences(row, other):
    return bytes((a - b) & 255 for a, b in zip(row, other))


def changed_box(before, after):
    """The smallest box that holds every pixel that differs: x, y, width, height."""
    lines = [y for y in range(len(after)) if before[y] != after[y]] or [0]
    columns = [x for y in lines for x in differing(before[y], after[y])] or [0]
    return min(columns), lines[0], max(columns) - min(columns) + 1, lines[-1] - lines[0] + 1


def differing(before, after):
    return [at // 4 for at in range(0, len(after), 4) if before[at : at + 4] != after[at : at + 4]]


def changes(before, after, box):
    """The box's rows; unchanged pixels are transparent."""
    x, y, width, height = box
    rows = []
    for line in range(y, y + height):
        row = bytearray(4 * width)
        for at in differing(before[line], after[line]):
            row[4 * (at - x) : 4 * (at - x) + 4] = after[line][4 * at : 4 * at + 4]
        rows.append(bytes(row))
    return rows


def write_png(file, frames, delays_ms):
    """Writes one frame as a PNG, several as an APNG that repeats for ever. Each frame holds what differs from the one before."""
    width, height = len(frames[0][0]) // 4, len(frames[0])
    if len(frames) == 1:
        opaque = [b"".join(row[at : at + 3] for at in range(0, len(row), 4)) for row in frames[0]]
        header = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)
        file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed(opaque, 3)) + chunk(b"IEND", b""))
        return
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 6, 0, 0, 0)) + chunk(b"acTL", struct.pack(">2I", len(frames), 0))
    number = 0
    for i, (frame, delay) in enumerate(zip(frames, delays_ms)):
        x, y, w, h = changed_box(frames[i - 1], frame) if i else (0, 0, width, height)
        rows = changes(frames[i - 1], frame, (x, y, w, h)) if i else frame
        keep, draw_over = 0, 1
        data += chunk(b"fcTL", struct.pack(">5I2H2B", number, w, h, x, y, delay, 1000, keep, draw_over))
        number += 1
        if i == 0:
            data += chunk(b"IDAT", packed(rows, 4))
        else:
            data += chunk(b"fdAT", struct.pack(">I", number) + packed(rows, 4))
            number += 1
    file.write_bytes(data + chunk(b"IEND", b""))


def cropped(frame, crop):
    left, top, width, height = crop
    return [row[4 * left : 4 * (left + width)] for row in frame[top : top + height]]


def pull(screen, kiosk):
    """Selects the sill's face and pulls its arrow. Returns the frames, their durations, and the index of the farthest one."""
    session("edit", json.dumps({"edit": "select_region", "at": SILL_FACE, "angle": 30}))
    kiosk.wait_for(lambda line: line.startswith("handle ") and line != "handle none")
    foot = kiosk.handle[:2]
    kiosk.move(*foot)
    kiosk.zoom(*foot)
    kiosk.pan(*MIDDLE)
    x0, y0, x1, y1 = kiosk.handle
    length = math.hypot(x1 - x0, y1 - y0)
    frames, delays = [], []

    def shoot(delay):
        frames.append(screen.pixels())
        delays.append(delay)

    away = (x1 + 60, y1 + 110)
    kiosk.move(*away)
    shoot(REST_MS)
    for part in (0.35, 0.7, 1):
        kiosk.move(away[0] + part * (x1 - away[0]), away[1] + part * (y1 - away[1]))
        shoot(STEP_MS)
    kiosk.press(x1, y1)
    for step in range(1, STEPS + 1):
        part = (1 - math.cos(math.pi * step / STEPS)) / 2
        kiosk.move(x1 + part * PULL_PIXELS * (x1 - x0) / length, y1 + part * PULL_PIXELS * (y1 - y0) / length)
        shoot(STEP_MS)
    delays[-1] = REST_MS
    farthest = len(frames) - 1
    kiosk.release()
    time.sleep(0.5)
    shoot(REST_MS + 600)
    return frames, delays, farthest


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "pictures"
    home = pathlib.Path(tempfile.gettempdir()) / "prismesh-pull"  # the picture shows this name
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir(mode=0o700)
    for name in ("run", "state", "config", "screen"):
        (home / name).mkdir(mode=0o700)
    os.environ.update(RUNTIME_DIRECTORY=str(home / "run"), STATE_DIRECTORY=str(home / "state"), XDG_CONFIG_HOME=str(home / "config"), XDG_STATE_HOME=str(home / "state"))
    deck = home / "sample.k"
    subprocess.run([BIN / "prismesh", "sample", "-o", deck], check=True, stdout=subprocess.DEVNULL)
    screen = Screen(home / "screen")
    processes = [screen.server, subprocess.Popen([BIN / "prismesh-modeld"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)]
    try:
        kiosk = Kiosk(screen, deck)
        processes.append(kiosk.process)
        frames, delays, farthest = pull(screen, kiosk)
        kiosk.first_error()
        panel = screen.pixels()
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait(TIMEOUT_S)
        shutil.rmtree(home, ignore_errors=True)
    write_png(folder / "kiosk.png", [frames[farthest]], [0])
    write_png(folder / "pull.png", [cropped(frame, CROP) for frame in frames], delays)
    write_png(folder / "quality_panel.png", [cropped(panel, PANEL_CROP)], [0])


if __name__ == "__main__":
    main()
