#!/usr/bin/env python3
"""Bonds on decks, by a script that reads the decks' text alone: a strip is made, the session is killed, recovered, undone and saved.

    bond_proof.py PRISMESH PRISMESH_MODELD

1. `prismesh edit` bonds two sheets, flat ones and rings about a barrel. Every line of the deck is still there, in order; each hexahedron has a
   positive volume at each corner; its corners lie half a thickness above the one sheet and below the other; new numbers are new; the cards of the
   part name each other.
2. The same is made in modeld, which is killed (SIGKILL); recovered, it saves the same bytes; after undo it saves the deck's.
"""
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile

from weld_proof import Modeld, cards, columns, cross, dot, minus, nodes_of, shells_of

THICKNESS, GAP = 1.2, 0.4
EDIT = {"edit": "bond", "flange": {"between": "1,2"}, "width": 12, "length": 7, "density": 1.2e-9, "youngs_modulus": 2000,
        "poissons_ratio": 0.4}


def deck(place, columns_along, closed):
    """Two sheets of 4 rows; `place(i, j, height)` is a node's place."""
    nodes, shells = [], []
    along = columns_along + (0 if closed else 1)
    for part in (1, 2):
        for j in range(5):
            for i in range(along):
                x, y, z = place(i, j, (part - 1) * (THICKNESS + GAP))
                nodes.append(f"{5000 * part + along * j + i:8d}{x:16.8f}{y:16.8f}{z:16.8f}")
        for j in range(4):
            for i in range(columns_along):
                corner = lambda k, row: 5000 * part + along * row + k % along
                ids = (corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1))
                shells.append(f"{5000 * part + columns_along * j + i:8d}{part:8d}" + "".join(f"{n:8d}" for n in ids))
    return "\n".join(["*KEYWORD", "*NODE", *nodes, "*ELEMENT_SHELL", *shells, "*PART", "lower", f"{1:10d}{1:10d}{1:10d}", "*PART", "upper",
                      f"{2:10d}{1:10d}{1:10d}", "*SECTION_SHELL", f"{1:10d}{2:10d}", f"{THICKNESS:10.2f}" * 4, "*MAT_ELASTIC",
                      f"{1:10d}{7.85e-9:10.2e}{210000:10d}{0.3:10.1f}", "*END", ""])


def flat(i, j, height):
    return 5.0 * i, 5.0 * j, 7 + height


def barrel(i, j, height):
    angle, radius = 2 * math.pi * i / 120, 100 + height
    return radius * math.cos(angle), 5.0 * j, radius * math.sin(angle)


def distance_from_triangle(p, a, b, c):
    """The distance from the triangle's plane if the foot is in it, with room for rounding."""
    normal = cross(minus(b, a), minus(c, a))
    size = dot(normal, normal) ** 0.5
    inside = all(dot(cross(minus(v, u), minus(p, u)), normal) >= -1e-3 * size * size for u, v in ((a, b), (b, c), (c, a)))
    return abs(dot(minus(p, a), normal)) / size if inside else math.inf


def distance(p, part, nodes, shells):
    near = math.inf
    for owner, ids in shells.values():
        if owner != part:
            continue
        q = [nodes[n] for n in ids]
        if max(dot(minus(p, x), minus(p, x)) for x in q) > 12 ** 2:
            continue
        near = min(near, distance_from_triangle(p, q[0], q[1], q[2]), distance_from_triangle(p, q[0], q[2], q[3]))
    return near


def solids_of(text):
    return {int(f[0]): (int(f[1]), [int(n) for n in f[2:10]]) for f in (columns(l, (8,) * 10) for l in cards(text, "*ELEMENT_SOLID"))}


def check(before, after, count, tolerance):
    old, added, at = before.splitlines(), [], 0
    for line in after.splitlines():
        if at < len(old) and line == old[at]:
            at += 1
        else:
            added.append(line)
    assert at == len(old), f"line {at + 1} of the deck is gone: {old[at]!r}"
    nodes_before, nodes, shells, solids = nodes_of(before), nodes_of(after), shells_of(before), solids_of(after)
    assert len(solids) == count == len(cards(after, "*ELEMENT_SOLID")), f"{len(solids)} hexahedra instead of {count}"
    assert len(nodes) == len(cards(after, "*NODE")), "a node's number is there twice"
    assert not set(solids) & set(shells), "a solid has the number of a shell"
    used, volume = set(), 0
    for id, (_, corners) in solids.items():
        assert len(set(corners)) == 8 and not set(corners) & set(nodes_before), f"solid {id} has a node that isn't the bond's own"
        used |= set(corners)
        q = [nodes[n] for n in corners]
        # at each corner: the next ones of its own face, then the opposite one; of the upper face in the other order
        for c in range(4):
            low = (q[(c + 1) % 4], q[(c + 3) % 4], q[c + 4])
            high = (q[4 + (c + 3) % 4], q[4 + (c + 1) % 4], q[c])
            for p, (a, b, d) in ((q[c], low), (q[c + 4], high)):
                assert dot(cross(minus(a, p), minus(b, p)), minus(d, p)) > 0, f"solid {id} has no volume at a corner"
        sides = []
        for face in (q[:4], q[4:]):
            on = {part for part in (1, 2) if all(abs(distance(p, part, nodes, shells) - THICKNESS / 2) < tolerance for p in face)}
            assert len(on) == 1, f"a face of solid {id} lies on the faces of {on}, not of one sheet"
            sides.append(on.pop())
        assert sides[0] != sides[1], f"solid {id} lies on one sheet twice"
        middle = [sum(p[k] for p in q[:4]) / 4 for k in range(3)], [sum(p[k] for p in q[4:]) / 4 for k in range(3)]
        volume += dot(minus(middle[1], middle[0]), minus(middle[1], middle[0])) ** 0.5 / count
    assert used == set(nodes) - set(nodes_before), "a new node belongs to no solid"
    assert abs(volume - GAP) < 2 * tolerance, f"the adhesive is {volume} thick"
    part = {part for part, _ in solids.values()}
    assert len(part) == 1
    part = part.pop()
    new = "\n".join(added)
    for keyword in ("*SECTION_SOLID", "*MAT_ELASTIC", "*SET_PART_LIST", "*CONTACT_TIED_NODES_TO_SURFACE_OFFSET"):
        assert int(columns(cards(new, keyword)[0], (10,))[0]) == part, keyword
    assert [int(f) for f in columns(cards(new, "*PART")[1], (10,) * 3)] == [part] * 3
    assert [int(f) for f in columns(cards(new, "*SET_PART_LIST")[1], (10,) * 2)] == [1, 2]
    assert [int(f) for f in columns(cards(new, "*CONTACT_TIED_NODES_TO_SURFACE_OFFSET")[0], (10,) * 4)] == [part, part, 3, 2]
    print(f"  {len(solids)} hexahedra with {len(used)} nodes between two sheets; {len(old)} lines as before, {len(added)} added")


def read(path):
    with open(path, newline="") as file:
        return file.read()


def main():
    prismesh, modeld = sys.argv[1:3]
    folder = tempfile.mkdtemp(prefix="prismesh-bonds-")
    try:
        for name, text, count, tolerance in (("flat", deck(flat, 40, False), 29, 1e-6), ("ring", deck(barrel, 120, True), 90, 0.04)):
            path = os.path.join(folder, name, "deck.k")
            os.makedirs(os.path.dirname(path))
            with open(path, "w", newline="") as file:
                file.write(text)
            out = os.path.join(folder, name, "out", "deck.k")
            done = subprocess.run([prismesh, "edit", path, "--edit", json.dumps(EDIT), "-o", out, "--json"], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr[-2000:]
            said = json.loads(done.stdout.splitlines()[0])
            assert said["solids_left"] == 0 and said["solids_added"] == count, said
            words = subprocess.run([prismesh, "edit", path, "--edit", json.dumps(EDIT), "-o", out], capture_output=True, text=True, check=True)
            assert words.stdout.startswith(f"bond: {count} solids added; 0 left out\n  {count} solids added to part:3, "), words.stdout
            print(f"{name}:")
            after = read(out)
            check(text, after, count, tolerance)
            again = subprocess.run([prismesh, "info", out, "--json"], capture_output=True, text=True, check=True)
            assert json.loads(again.stdout)["elements"]["solid"] == count

        script = os.path.join(folder, "bond.jsonl")
        with open(script, "w") as file:
            file.write(json.dumps(EDIT) + "\n")
        daemon = Modeld(modeld, prismesh, folder)
        daemon.session("open", path)
        daemon.session("edit", "--script", script)
        daemon.kill(signal.SIGKILL)
        other = os.path.join(folder, "other")
        shutil.copytree(os.path.join(folder, "state"), os.path.join(other, "state"))
        daemon = Modeld(modeld, prismesh, folder)
        daemon.session("open", path)
        recovered = os.path.join(folder, "recovered.k")
        daemon.session("save", recovered)
        daemon.kill(signal.SIGTERM)
        assert read(recovered) == after, "recovered, another deck is saved"
        print("killed and recovered: the same bytes are saved")
        daemon = Modeld(modeld, prismesh, other)
        daemon.session("open", path)
        daemon.session("undo")
        undone = os.path.join(folder, "undone.k")
        daemon.session("save", undone)
        daemon.kill(signal.SIGTERM)
        assert read(undone) == text, "undone, another deck is saved"
        print("undone: the original's bytes are saved")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
