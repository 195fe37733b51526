#!/usr/bin/env python3
"""Makes the documentation's pictures of free endings: docs/pictures/free_ends_*.png.

    scripts/free_ends_pictures.py [FOLDER]      FOLDER: where the pictures are written; default docs/pictures

Writes a strip of 200 x 100 mm, lifts it and turns it with each value of free_ends, and draws what comes out, with the programs of build/bin.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = pathlib.Path(os.environ.get("PRISMESH_PROGRAMS", ROOT / "build" / "bin"))
COLUMNS, ROWS, SIDE = 40, 20, 5.0
HELD_AT, GRAB_AT = 50, 120
ENDS = {"": True, "_weighted": "weighted", "_false": False}
EDITS = {
    "lift": {"edit": "lift", "distance": 25},
    "turn": {"edit": "rotate", "point": [GRAB_AT, 0, 0], "axis": [0, 1, 0], "degrees": -30},
}


def node(i, j):
    return 1 + i + (COLUMNS + 1) * j


def write_strip(path):
    cards = ["*KEYWORD", "*NODE"]
    for j in range(ROWS + 1):
        cards += [f"{node(i, j):8d}{SIDE * i:16.6f}{SIDE * j:16.6f}{0:16.6f}" for i in range(COLUMNS + 1)]
    cards.append("*ELEMENT_SHELL")
    for j in range(ROWS):
        for i in range(COLUMNS):
            corners = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
            cards.append(f"{1 + i + COLUMNS * j:8d}{1:8d}" + "".join(f"{corner:8d}" for corner in corners))
    cards += ["*PART", "strip", f"{1:10d}{1:10d}{1:10d}", "*SECTION_SHELL", f"{1:10d}{2:10d}", f"{1.0:10.1f}" * 4]
    cards += ["*MAT_ELASTIC", f"{1:10d}{7.85e-9:10.2e}{210000.0:10.1f}{0.3:10.1f}", "*END", ""]
    path.write_text("\n".join(cards))


def prismesh(*arguments):
    done = subprocess.run([BIN / "prismesh", *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise SystemExit(f"free_ends_pictures: {done.stderr}")


def main():
    pictures = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "pictures"
    with tempfile.TemporaryDirectory() as folder:
        strip, shaped = pathlib.Path(folder) / "strip.k", pathlib.Path(folder) / "shaped.k"
        write_strip(strip)
        first = round(HELD_AT / SIDE)
        nodes = ",".join(f"{node(first, j)}-{node(COLUMNS, j)}" for j in range(ROWS + 1))
        for name, edit in EDITS.items():
            for suffix, free_ends in ENDS.items():
                whole = dict(edit, on=nodes, grab=node(round(GRAB_AT / SIDE), ROWS // 2), free_ends=free_ends)
                prismesh("edit", strip, "--edit", json.dumps(whole), "-o", shaped)
                picture = pictures / f"free_ends_{name}{suffix}.png"
                prismesh("render", shaped, "-o", picture, "--size", "480x300", "--profile", "mono", "--view", "iso")


if __name__ == "__main__":
    main()
