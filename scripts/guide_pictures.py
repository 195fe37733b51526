#!/usr/bin/env python3
"""Makes the pictures of docs/guide: goes the guide's way in a real kiosk, by pointer and keyboard, and copies the screen at each step.

    scripts/guide_pictures.py [FOLDER]      FOLDER: where the pictures are written; default docs/guide/pictures

Runs the programs of build/bin on an X server without a screen. Ends with status 1 if a step doesn't do what the guide says. Needs the packages of
the section [test] in packages.txt.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import pull_pictures as station  # noqa: E402

station.WIDTH, station.HEIGHT = 1200, 760
PULL_PIXELS = 48
SILL_FACE = (1180.0, -84.0, 0.0)
MIDDLE = 520, 360  # where the face is brought: about the middle of the view


class GuideKiosk(station.Kiosk):
    """A kiosk without a deck, whose trace tells where things are."""

    def __init__(self, screen):
        self.environment = dict(os.environ, DISPLAY=screen.name)
        self.presses = self.releases = 0
        self.aim, self.items = None, {}
        command = [station.BIN / "prismesh-kiosk", "--trace", "--size", f"{station.WIDTH}x{station.HEIGHT}"]
        self.process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        self.wait_for(lambda line: line.startswith("picture "))
        self.xdotool("search", "--sync", "--onlyvisible", "--name", "^Prismesh$", "windowmove", "--sync", "0", "0", "windowfocus")

    def wait_for(self, wanted):
        def noted(line):
            if line.startswith("aim "):
                self.aim = [float(word) for word in line.split()[1:]]
            if line.startswith('item "') and not line.endswith(" gone"):
                name, rest = line[6:].split('" ', 1)
                self.items[name] = [float(word) for word in rest.split()[:4]]
            return wanted(line)

        super().wait_for(noted)

    def wait(self, *beginnings):
        """Reads the trace up to a line that begins so; of several, one after the other."""
        for beginning in beginnings:
            self.wait_for(lambda line, beginning=beginning: line.startswith(beginning))

    def key(self, *keys):
        self.xdotool("key", "--delay", 30, *keys)

    def type(self, text):
        self.xdotool("type", "--delay", 15, text)

    def click(self, x, y, times=1):
        self.move(x, y)
        self.xdotool("click", "--repeat", times, "--delay", 40, 1)
        self.presses += times
        self.releases += times

    def click_item(self, name):
        x, y, width, height = self.items[name]
        self.click(x + width / 2, y + height / 2)

    def pixel(self, x, y, z):
        width, height, m = self.aim[0], self.aim[1], self.aim[2:]
        row = [m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r] for r in (0, 1, 3)]
        return (row[0] / row[2] + 1) / 2 * width, (1 - row[1] / row[2]) / 2 * height


def walk(kiosk, shoot, deck):
    kiosk.key("ctrl+o", "ctrl+a")
    kiosk.type(f"{deck.parent}/")
    shoot("open")
    kiosk.key("ctrl+a")
    kiosk.type(str(deck))
    kiosk.key("Return")
    kiosk.wait("generation ", "aim ", "picture ")
    at = kiosk.pixel(*SILL_FACE)
    kiosk.move(*at)
    kiosk.zoom(*at)
    kiosk.pan(*MIDDLE)
    kiosk.click(*kiosk.pixel(*SILL_FACE), times=2)
    kiosk.wait_for(lambda line: line.startswith("handle ") and line != "handle none")
    kiosk.wait("picture ")
    shoot("select")
    x0, y0, x1, y1 = kiosk.handle
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
    kiosk.move(x1, y1)
    kiosk.press(x1, y1)
    for part in (0.3, 0.6, 1):
        kiosk.move(x1 + part * PULL_PIXELS * (x1 - x0) / length, y1 + part * PULL_PIXELS * (y1 - y0) / length)
    shoot("pull")
    kiosk.release()
    kiosk.first_error()
    shoot("quality")
    kiosk.key("ctrl+e")
    kiosk.wait("reads information")
    kiosk.key("Escape")  # what the repair reports
    kiosk.wait("reads none", "picture ")
    shoot("repair")
    kiosk.key("j", "ctrl+f", "ctrl+c")
    kiosk.wait("view beside", "picture ")
    shoot("compare")
    kiosk.key("ctrl+c")
    kiosk.wait("picture ")
    kiosk.click_item("tab History")
    shoot("history")
    kiosk.key("ctrl+p")
    kiosk.type("hide")
    shoot("find")
    kiosk.key("Escape", "ctrl+shift+c", "ctrl+a")
    kiosk.type(str(deck.with_name("stiffer.k")))
    shoot("save")
    kiosk.key("Return")
    kiosk.wait("saved ")


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else station.ROOT / "docs" / "guide" / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    home = pathlib.Path(tempfile.gettempdir()) / "prismesh-guide"  # the pictures show this name
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir(mode=0o700)
    for name in ("run", "state", "config", "screen", "decks"):
        (home / name).mkdir(mode=0o700)
    os.environ.update(RUNTIME_DIRECTORY=str(home / "run"), STATE_DIRECTORY=str(home / "state"), XDG_CONFIG_HOME=str(home / "config"), XDG_STATE_HOME=str(home / "state"))
    deck = home / "decks" / "sample.k"
    subprocess.run([station.BIN / "prismesh", "sample", "-o", deck], check=True, stdout=subprocess.DEVNULL)
    screen = station.Screen(home / "screen")
    processes = [screen.server, subprocess.Popen([station.BIN / "prismesh-modeld"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)]

    def shoot(name):
        time.sleep(0.8)  # the view's way, tooltips, and the X server's copy
        station.write_png(folder / f"{name}.png", [screen.pixels()], [0])
        print(f"guide_pictures: {name}.png", flush=True)

    try:
        kiosk = GuideKiosk(screen)
        processes.append(kiosk.process)
        walk(kiosk, shoot, deck)
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait(station.TIMEOUT_S)
        shutil.rmtree(home, ignore_errors=True)


if __name__ == "__main__":
    main()
