#!/usr/bin/env python3
"""Welds in Nastran decks, by a script that reads the decks' text alone.

    nastran_welds_proof.py PRISMESH PRISMESH_MODELD

`prismesh edit` welds two sheets along their flange, as a new property and then like its first weld, in small fields, free fields and with CR LF.
Every line of the deck is still there, in order; each CWELD names a grid point on either sheet, exactly on it, and the properties of these two
sheets in the order of its ends; its PWELD names a MAT1; every number is new. The same edits in modeld: killed (SIGKILL) and recovered it saves
the same bytes; undone, the deck's. With PRISMESH_MODELS also twelve welds on a real car: each end lies on a shell of the property that is named.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

from bond_proof import distance_from_triangle
from session_proof import added_lines, prove_session, read

COLUMNS, ROWS, SIDE, DISTANCE = 20, 4, 5.0, 1.6
PROPERTY = {1: 10, 2: 20}


def node(part, i, j):
    return 1000 * part + 50 * j + i + 1


def deck(free, eol):
    def card(*fields):
        if free:
            return ",".join(map(str, fields))
        return (str(fields[0]).ljust(8) + "".join(str(f).rjust(8) for f in fields[1:])).rstrip()
    lines = ["SOL 101", "CEND", "BEGIN BULK", "$ two flanges"]
    for part in (1, 2):
        lines += [card("GRID", node(part, i, j), "", f"{SIDE * i}", f"{SIDE * j}", f"{(part - 1) * DISTANCE}") for j in range(ROWS + 1)
                  for i in range(COLUMNS + 1)]
    for part in (1, 2):
        lines += [card("CQUAD4", 1000 * part + COLUMNS * j + i + 1, PROPERTY[part], node(part, i, j), node(part, i + 1, j),
                       node(part, i + 1, j + 1), node(part, i, j + 1)) for j in range(ROWS) for i in range(COLUMNS)]
    lines += [card("PSHELL", PROPERTY[part], 1, "1.2", 1, "", 1) for part in (1, 2)]
    lines += [card("MAT1", 40, "210000.", "", "0.3", "7.85-9"), card("MAT1", 1, "200000.", "", "0.31", "7.8-9"), "ENDDATA", ""]
    return eol.join(lines)


def entries(text):
    """The fields of each entry of the bulk data, its continuations appended; the name first."""
    out, lines = [], text.splitlines()
    for line in lines[next(k for k, line in enumerate(lines) if line.startswith("BEGIN BULK")) + 1:]:
        if line.startswith("$") or not line.strip():
            continue
        if line.startswith("ENDDATA"):
            return out
        fields = line.split(",")[:9] if "," in line[:10] else [line[k:k + 8] for k in range(0, 72, 8)]
        fields = [f.strip() for f in fields] + [""] * (9 - len(fields))
        if fields[0] == "" or fields[0][0] in "+*":
            out[-1] += fields[1:]
        else:
            out.append(fields)
    raise AssertionError("there is no ENDDATA")


def by_name(all, name):
    return [fields[1:] for fields in all if fields[0] == name]


def real(text):
    """A number as Nastran writes it: 7.85-9."""
    for k in range(1, len(text)):
        if text[k] in "+-" and text[k - 1] not in "eEdD":
            return float(text[:k] + "e" + text[k:])
    return float(text)


def check(before, after, welds):
    added = added_lines(before, after)
    old, new = entries(before), entries(after)
    grids = {int(f[0]): tuple(real(x) for x in f[2:5]) for f in by_name(new, "GRID")}
    assert len(grids) == len(by_name(new, "GRID")), "a grid point's number is there twice"
    taken = {int(f[0]) for f in by_name(old, "GRID")}
    elements = [int(f[0]) for name in ("CQUAD4", "CWELD") for f in by_name(new, name)]
    assert len(elements) == len(set(elements)), "an element's number is there twice"
    cards, used = by_name(new, "CWELD"), set()
    assert len(cards) == welds, f"{len(cards)} welds instead of {welds}"
    for f in cards:
        assert f[2] == "" and f[3] == "PARTPAT", f
        ends, sheets = (int(f[4]), int(f[5])), (int(f[8]), int(f[9]))
        assert not used & set(ends) and not taken & set(ends), f"weld {f[0]} has a grid point that isn't its own"
        used |= set(ends)
        assert set(sheets) == set(PROPERTY.values())
        for end, sheet in zip(ends, sheets):
            x, y, z = grids[end]
            assert abs(z - (DISTANCE if sheet == PROPERTY[2] else 0)) < 1e-6, f"an end of weld {f[0]} isn't on the sheet that it names"
            assert 0 < x < SIDE * COLUMNS and 0 < y < SIDE * ROWS
        assert all(abs(a - b) < 1e-6 for a, b in zip(grids[ends[0]][:2], grids[ends[1]][:2])), "its ends aren't opposite"
    assert used == set(grids) - taken, "a new grid point belongs to no weld"
    property = {int(f[1]) for f in cards}
    assert len(property) == 1
    property = property.pop()
    assert property not in {int(f[0]) for f in by_name(old, "PSHELL")}
    (number, material, diameter), = [f[:3] for f in by_name(new, "PWELD")]
    assert int(number) == property and real(diameter) == 6
    found = [f for f in by_name(new, "MAT1") if f[0] == material]
    assert len(found) == 1 and material not in {f[0] for f in by_name(old, "MAT1")}
    assert [real(found[0][k]) for k in (1, 3, 4)] == [200000, 0.31, 7.8e-9], "the material isn't that of the sheets"
    print(f"  {len(cards)} welds with {len(used)} grid points on two sheets; {len(added)} lines added, the others as before")


def check_car(prismesh, deck, folder):
    """Welds between two properties of a car whose flanges aren't planes; grid points are rounded to eight columns."""
    out = os.path.join(folder, "car.nas")
    edit = {"edit": "weld", "flange": {"between": "2,19", "gap": 5}, "pitch": 30, "diameter": 6, "gap": 5}
    done = subprocess.run([prismesh, "edit", deck, "--edit", json.dumps(edit), "-o", out, "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    count = json.loads(done.stdout)["welds_added"]
    assert count >= 10, f"{count} welds"
    with open(deck, errors="surrogateescape", newline="") as file:
        before = file.read()
    with open(out, errors="surrogateescape", newline="") as file:
        after = file.read()
    added_lines(before, after)
    new = entries(after)
    grids = {int(f[0]): tuple(real(x) for x in f[2:5]) for f in by_name(new, "GRID")}
    welds = by_name(new, "CWELD")
    assert len(welds) == count
    for f in welds:
        for end, sheet in ((int(f[4]), f[8]), (int(f[5]), f[9])):
            near = min(distance_from_triangle(grids[end], *(grids[n] for n in triangle)) for name, corners in (("CQUAD4", 4), ("CTRIA3", 3))
                       for shell in by_name(new, name) if shell[1] == sheet
                       for triangle in [[int(n) for n in shell[2:5]], [int(shell[2]), int(shell[4]), int(shell[1 + corners])]][:corners - 2])
            assert near < 0.01, f"an end of weld {f[0]} is {near} from the sheet that it names"
    print(f"car: {count} welds, each end on the sheet that it names")


def main():
    programs = sys.argv[1:3]
    folder = tempfile.mkdtemp(prefix="prismesh-nastran-")
    try:
        for name, free, eol in (("small", False, "\n"), ("free", True, "\n"), ("crlf", False, "\r\n")):
            text = deck(free, eol)
            path, out = os.path.join(folder, name, "deck.bdf"), os.path.join(folder, name, "out", "deck.bdf")
            os.makedirs(os.path.dirname(path))
            with open(path, "w", newline="") as file:
                file.write(text)
            edits = [{"edit": "weld", "flange": {"between": "10,20"}, "pitch": 20, "diameter": 6},
                     {"edit": "weld", "points": [[20, 5, 0], [60, 14, 1]], "like": "spring:1"}]
            script = os.path.join(folder, name, "welds.jsonl")
            with open(script, "w") as file:
                file.writelines(json.dumps(edit) + "\n" for edit in edits)
            done = subprocess.run([programs[0], "edit", path, "--script", script, "-o", out, "--json"], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr[-2000:]
            assert [json.loads(line)["welds_added"] for line in done.stdout.splitlines()] == [5, 2], done.stdout
            print(f"{name}:")
            after = read(out)
            assert after.count("\r\n") == (after.count("\n") if eol == "\r\n" else 0), "line ends are mixed"
            check(text, after, 7)
            again = subprocess.run([programs[0], "info", out, "--json"], capture_output=True, text=True, check=True)
            said = json.loads(again.stdout)
            assert not said["warnings"], said["warnings"]
            faults = subprocess.run([programs[0], "welds", out, "--json"], capture_output=True, text=True, check=True)
            assert json.loads(faults.stdout) == {"welds": 7, "findings": []}, faults.stdout
            if name == "small":
                prove_session(programs, os.path.join(folder, "session"), path, edits, after)
        car = os.path.join(os.environ.get("PRISMESH_MODELS", ""), "simplecar_nas", "full_car.nas")
        if os.path.exists(car):
            check_car(programs[0], car, folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
