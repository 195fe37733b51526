#!/usr/bin/env python3
"""Measures a real kiosk with a large model in a window of a virtual display: how long the input isn't looked at, how long pictures take,
how much memory the kiosk holds; at rest, while the view turns, after an edit of 10,000 nodes, and while the model server works.
Needs Xvfb, openbox and xdotool. Usage: large_kiosk.py FOLDER_OF_PROGRAMS DECK"""
import json
import os
import pathlib
import queue
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time


class Program:
    def __init__(self, *command, **environment):
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env={**os.environ, **environment})
        self.lines, self.new = [], queue.Queue()
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            self.lines.append((time.monotonic(), line.rstrip()))
            self.new.put(self.lines[-1])

    def wait_for(self, beginning, limit_s=120):
        end = time.monotonic() + limit_s
        while True:
            at, line = self.new.get(timeout=max(0.01, end - time.monotonic()))
            if line.startswith(beginning):
                return at, line

    def settle(self, quiet_s=1.5):
        """Until it rests and nothing more is said."""
        said = -1
        while said != len(self.lines) or not self.lines[-1][1].startswith(("rests", "levels")):
            said = len(self.lines)
            time.sleep(quiet_s)

    def since(self, start, beginning):
        return [line for at, line in self.lines if at >= start and line.startswith(beginning)]

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(20)


def memory_of(pid):
    """MB: resident, of it shared with other processes (the snapshot), highest so far."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return tuple(round(int(re.search(name + r":\s+(\d+)", status)[1]) / 1000) for name in ("VmRSS", "RssShmem", "VmHWM"))


def cpu_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def numbers(lines):
    return [float(re.search(r"(\d+(\.\d+)?) ms", line)[1]) for line in lines]


def tell_times(what, values):
    values = sorted(values)
    if values:
        print(f"{what}: {len(values)} times, median {statistics.median(values):.0f} ms, p99 {values[len(values) * 99 // 100]:.0f}, longest {values[-1]:.0f}", flush=True)


class Stage:
    def __init__(self, programs, folder):
        display = Program("Xvfb", "-displayfd", "1", "-screen", "0", "1640x940x24", "-nolisten", "tcp")
        self.name = ":" + display.wait_for("")[1]
        manager = Program("openbox", "--sm-disable", "--startup", "echo ready", DISPLAY=self.name, HOME=folder)
        manager.wait_for("ready")
        self.environment = {"RUNTIME_DIRECTORY": folder + "/run", "STATE_DIRECTORY": folder + "/state", "DISPLAY": self.name,
                            "XDG_CONFIG_HOME": folder, "XDG_STATE_HOME": folder}
        for name in ("run", "state"):
            os.makedirs(f"{folder}/{name}", mode=0o700)
        self.programs = programs
        self.server = Program(f"{programs}/prismesh-modeld", **self.environment)
        time.sleep(0.5)
        self.kiosk = None
        self.others = [display, manager]

    def start_kiosk(self, deck):
        self.kiosk = Program(f"{self.programs}/prismesh-kiosk", "--trace", "--runtime-dir", self.environment["RUNTIME_DIRECTORY"], "--size",
                             "1600x900", "--open", deck, **self.environment)

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env={**os.environ, **self.environment}, check=True)

    def turn(self, steps):
        """Drags with the right button."""
        self.xdotool("mousemove", 700, 450, "mousedown", 3)
        for step in range(steps):
            self.xdotool("mousemove", 700 + 3 * (step % 80), 450 + step % 30)
            time.sleep(0.05)
        self.xdotool("mouseup", 3)

    def session(self, *words):
        return subprocess.run([f"{self.programs}/prismesh", "session", "--runtime-dir", self.environment["RUNTIME_DIRECTORY"], *words],
                              capture_output=True, text=True, env={**os.environ, **self.environment})

    def phase(self, what, work):
        start, cpu = time.monotonic(), cpu_s(self.kiosk.process.pid)
        work()
        self.kiosk.settle()
        tell_times(f"{what}: the input isn't looked at for", numbers(self.kiosk.since(start, "looked")))
        for pace in ("at rest", "moving", "waiting"):
            tell_times(f"{what}: pictures {pace}", numbers(self.kiosk.since(start, f"drawn {pace}")))
        print(f"{what}: {cpu_s(self.kiosk.process.pid) - cpu:.2f} s of processor time; memory (resident, shared, highest) {memory_of(self.kiosk.process.pid)} MB", flush=True)
        return start

    def end(self):
        for program in [self.kiosk, self.server, *reversed(self.others)]:
            if program:
                program.end()


def main(programs, deck):
    with tempfile.TemporaryDirectory(prefix="large_") as folder:
        stage = Stage(programs, folder)
        try:
            measure(stage, os.path.abspath(deck))
        finally:
            stage.end()


def measure(stage, deck):
    stage.start_kiosk(deck)
    stage.phase("opening", lambda: stage.kiosk.wait_for("levels"))
    stage.phase("turning", lambda: stage.turn(100))

    def pointed():
        for k in range(5):
            stage.xdotool("mousemove", 600 + 40 * k, 450)
            time.sleep(0.6)
    stage.phase("pointing", pointed)

    def edit(which, *edits):
        start = time.monotonic()
        done = stage.session("edit", *map(json.dumps, edits))
        if done.returncode:
            print(done.stdout, done.stderr)
        at = next((at for at, line in stage.kiosk.lines if at >= start and line.startswith("picture")), None)
        if at:
            print(f"{which}: first picture {1000 * (at - start):.0f} ms after it was sent")
    stage.phase("selecting 10,000 nodes", lambda: edit("selection", {"edit": "select", "expr": "5000001-5010000", "kind": "node"}))
    stage.phase("an edit of 10,000 nodes", lambda: edit("edit", {"edit": "translate", "by": [0, 0, 1]}))

    def edits_while_turning():
        worker = threading.Thread(target=lambda: [edit("edit", {"edit": "translate", "by": [0, 0, (-1) ** k]}) for k in range(5)])
        worker.start()
        while worker.is_alive():
            stage.turn(20)
    stage.phase("turning while the model server edits 10,000 nodes, 5 times", edits_while_turning)


if __name__ == "__main__":
    main(*sys.argv[1:3])
