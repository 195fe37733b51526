#!/usr/bin/env python3
"""The demo on every real deck with shells that PRISMESH_MODELS points to.

    demo_decks.py [--whole] [--programs FOLDER] [DECK..]     DECK: names in counts.json, all without; FOLDER: of the programs, build/bin without

For each deck `demo/play` must do all its steps, or end with one sentence that says why it can't. A Python traceback, a second line of
reasons or a time beyond the limit is a failure. `--whole` draws the pictures and shows stereo as well; without it only the edits are made.
Prints a table; exit status 1 if a deck failed, 77 where there are no models.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

PLAY = pathlib.Path(__file__).resolve().parent.parent.parent / "demo" / "play"
LIMIT_S = 900


def play(main, options):
    """Returns what went wrong (empty: nothing), and how the demo ended."""
    with tempfile.TemporaryDirectory(prefix="demo-") as folder:
        try:
            done = subprocess.run([PLAY, "--out", folder, *options, main], capture_output=True, text=True, errors="replace", timeout=LIMIT_S, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return f"did not end within {LIMIT_S} s", ""
    said = done.stderr.strip()
    if "Traceback" in done.stdout + said:
        return f"a traceback: {said.splitlines()[-1]}", ""
    if done.returncode == 0:
        lines = [line for line in done.stdout.splitlines() if line.startswith(("lifted", "repaired", "stretched", "relaxed", "compared", "saved"))]
        told = {line.split()[0] for line in lines}
        missing = {"lifted", "stretched", "compared", "saved"} - told
        last = lines[-1] if lines else ""
        return f"steps are missing: {', '.join(sorted(missing))}" if missing else "", last
    if done.returncode == 1 and said.startswith("demo: ") and len(said.splitlines()) == 1:
        return "", said
    return f"ended with {done.returncode}: {said or done.stdout.strip()[-200:]}", ""


def main(arguments):
    options = ["--edits-only"]
    if "--whole" in arguments:
        arguments.remove("--whole")
        options = []
    if "--programs" in arguments:
        at = arguments.index("--programs")
        os.environ["PRISMESH_PROGRAMS"] = str(pathlib.Path(arguments[at + 1]).resolve())
        del arguments[at : at + 2]
    os.environ.pop("DISPLAY", None)  # or the kiosk would stay open
    models = pathlib.Path(os.environ.get("PRISMESH_MODELS", "/nowhere"))
    if not (models / "counts.json").exists():
        print("SKIPPED: PRISMESH_MODELS names no folder with real decks")
        return 77
    counts = json.loads((models / "counts.json").read_text())
    failed = 0
    for name in arguments or sorted(name for name, deck in counts.items() if deck["shells"] > 0):
        begun = time.monotonic()
        wrong, ended = play(models / counts[name]["main"], options)
        failed += bool(wrong)
        print(f"{name:32} {time.monotonic() - begun:6.1f} s  {'FAILED: ' + wrong if wrong else ended}", flush=True)
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
