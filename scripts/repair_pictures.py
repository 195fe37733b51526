#!/usr/bin/env python3
"""Makes the pictures of docs/repairing.md: shaped, repaired, and the distance from the original surface, side by side.

    scripts/repair_pictures.py [FOLDER]      FOLDER: where they are written; default docs/pictures

repairing_rail.png: the generated sample; repairing_bump.png: a generated plate; repairing_hatprofile.png: a real deck, only with PRISMESH_MODELS. The
programs of build/bin draw them; this script cuts out what the shaping changed.
"""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests" / "checker")]
sys.dont_write_bytecode = True
import check_deck  # noqa: E402
from pull_pictures import write_png  # noqa: E402

BIN = pathlib.Path(os.environ.get("PRISMESH_PROGRAMS", ROOT / "build" / "bin"))
PANEL, GAP = (436, 400), 6  # pixels: of each part of the result; between them


def prismesh(*arguments):
    done = subprocess.run([BIN / "prismesh", *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"repair_pictures: {done.stderr}")


def read_png(path):
    """Rows of four bytes a pixel, of a PNG with eight bits a channel and three or four channels."""
    data = path.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at:at + 4]), data[at + 4:at + 8]
        if kind == b"IHDR":
            width, height, depth, colours = struct.unpack(">2I2B", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += length + 12
    if depth != 8 or colours not in (2, 6):
        sys.exit(f"repair_pictures: {path} has another kind of pixels")
    step = 3 if colours == 2 else 4
    raw, rows, above = zlib.decompress(packed), [], bytearray(width * step)
    for y in range(height):
        begin = y * (width * step + 1)
        form, row = raw[begin], bytearray(raw[begin + 1:begin + 1 + width * step])
        for i in range(len(row) if form else 0):
            left, up = (row[i - step] if i >= step else 0), above[i]
            corner = above[i - step] if i >= step else 0
            near = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            row[i] = row[i] + (0, left, up, (left + up) // 2, near)[form] & 255
        above = row
        rows.append(b"".join(bytes(row[i:i + 3]) + b"\xff" for i in range(0, len(row), step)))
    return rows


def box_of(shaped, repaired, field):
    """The left and top corner of a box of PANEL's size about the median of the pixels that differ in all three."""
    different = []
    for y, rows in enumerate(zip(shaped, repaired, field)):
        if len(set(rows)) == 3:
            different += [(x, y) for x in range(len(rows[0]) // 4) if len({row[4 * x:4 * x + 4] for row in rows}) == 3]
    middle = (sorted(place[k] for place in different)[len(different) // 2] for k in (0, 1))
    limits = len(field[0]) // 4 - PANEL[0], len(field) - PANEL[1]
    return tuple(max(0, min(m - s // 2, limit)) for m, s, limit in zip(middle, PANEL, limits))


def make(file, deck, edit, size, target_size, limits):
    """`size`: of the picture of the whole deck."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        shaped, repaired, picture = folder / "shaped.k", folder / "repaired.k", folder / "picture.png"
        sized = ("--target-size", target_size)
        prismesh("edit", deck, *sized, "--edit", json.dumps(edit), "-o", shaped)
        prismesh("edit", deck, *sized, "--edit", json.dumps(edit), "--edit", json.dumps({"edit": "repair"}), "-o", repaired)
        drawn = []
        field = ("--colour", "distance-to-original", "--against", deck, "--limits", limits)
        for which, more in ((shaped, ()), (repaired, ()), (repaired, field)):
            prismesh("render", which, "-o", picture, *sized, "--size", size, "--profile", "mono", *more)
            drawn.append(read_png(picture))
        left, top = box_of(*drawn)
        gap = b"\xff" * (4 * GAP)
        rows = [gap.join(rows[y][4 * left:4 * (left + PANEL[0])] for rows in drawn) for y in range(top, top + PANEL[1])]
        write_png(file, [rows], [])


def nodes_within(deck, low, high):
    inside = [id for id, node in check_deck.read(str(deck)).nodes.items() if all(a <= c <= b for a, c, b in zip(low, node.basic(), high))]
    return ",".join(map(str, sorted(inside)))


def nearest(deck, point):
    return min(sorted(check_deck.read(str(deck)).nodes.items()), key=lambda item: sum((a - b) ** 2 for a, b in zip(item[1].basic(), point)))[0]


def write_plate(path, count=30, side=10.0):
    """A flat plate of quads."""
    across = range(count + 1)
    cards = ["*KEYWORD", "*NODE", *(f"{1 + i + j * (count + 1):8d}{i * side:16.6f}{j * side:16.6f}{0:16.6f}" for j in across for i in across),
             "*ELEMENT_SHELL"]
    for j in range(count):
        for i in range(count):
            a = 1 + i + j * (count + 1)
            cards.append(f"{1 + i + j * count:8d}{1:8d}" + "".join(f"{n:8d}" for n in (a, a + 1, a + count + 2, a + count + 1)))
    cards += ["*PART", "plate", f"{1:10d}{1:10d}{1:10d}", "*SECTION_SHELL", f"{1:10d}{2:10d}", f"{1.0:10.1f}" * 4,
              "*MAT_ELASTIC", f"{1:10d}{7.85e-9:10.2e}{210000.0:10.1f}{0.3:10.1f}", "*END", ""]
    path.write_text("\n".join(cards))


def lift(deck, distance, low, high, middle):
    return {"edit": "lift", "distance": distance, "grab": nearest(deck, middle), "on": nodes_within(deck, low, high)}


def main():
    pictures = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "pictures"
    with tempfile.TemporaryDirectory() as folder:
        sample, plate = pathlib.Path(folder) / "sample.k", pathlib.Path(folder) / "plate.k"
        prismesh("sample", "--elements", 18000, "-o", sample)
        make(pictures / "repairing_rail.png", sample, lift(sample, 32, (910, -85, -56), (1090, -83, 56), (1000, -84, 0)), "4000x2500", 10, "1,30")
        write_plate(plate)
        make(pictures / "repairing_bump.png", plate, lift(plate, 20, (100, 100, -1), (200, 200, 1), (150, 150, 0)), "1700x1060", 10, "1,20")
    models = os.environ.get("PRISMESH_MODELS")
    if not models:
        print("repair_pictures: PRISMESH_MODELS isn't set, so repairing_hatprofile.png stays as it is", file=sys.stderr)
        return
    hat = pathlib.Path(models) / "hatprofile" / "Hatprofile.k"
    make(pictures / "repairing_hatprofile.png", hat, lift(hat, 20, (80, -26, 31), (140, 26, 33), (110, 0, 32)), "2400x1500", 5, "1,20")


if __name__ == "__main__":
    main()
