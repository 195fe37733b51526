#!/usr/bin/env python3
"""Bonds and welds in Abaqus decks, by a script that reads the decks' text alone, and by CalculiX, which runs them.

    abaqus_joints_proof.py PRISMESH PRISMESH_MODELD

1. `prismesh edit` bonds two sheets. Every line of the deck is still there, in order; each hexahedron has a positive volume at each corner; its
   first face (S1) lies on the one sheet's face, its sixth (S2) on the other's; the names of the cards lead from the ties to the sheets.
2. The same edit in modeld: killed (SIGKILL) and recovered it saves the same bytes; undone, the deck's.
3. CalculiX (ccx) pulls the sheets apart. Without the bond no force goes through. With it the force is that of a lap joint by Volkersen's
   shear lag, which this script works out: sheets that stretch, an adhesive that shears. Left out where ccx isn't installed.
4. Welds along the flange, and more like the first: connectors with a node of their own on each sheet; the fastener names their set, and a
   surface of both sheets. CalculiX has no fasteners; no solver has run these.
"""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

from bond_proof import distance_from_triangle
from session_proof import added_lines, prove_session, read
from weld_proof import cross, dot, minus

THICKNESS, GAP, SIDE, COLUMNS, ROWS = 1.2, 0.4, 5.0, 12, 4
E_SHEET, E_GLUE, NU_GLUE, PULL = 210000.0, 2000.0, 0.4, 0.01
WIDTH, END = 12.0, 10.0
BOND = {"edit": "bond", "flange": {"between": "1,2"}, "width": WIDTH, "length": 7, "end_distance": END, "density": 1.2e-9,
        "youngs_modulus": E_GLUE, "poissons_ratio": NU_GLUE}


def node(part, i, j):
    return 1000 * part + 50 * j + i + 1


def deck(turned=(), gap=GAP):
    """Two sheets, fixed at one end of the lower one and pulled at the other end of the upper one. `turned`: parts whose shells point down."""
    lines = ["*HEADING", "two flanges", "*NODE"]
    for part in (1, 2):
        lines += [f"{node(part, i, j)}, {SIDE * i}, {SIDE * j}, {(part - 1) * (THICKNESS + gap)}" for j in range(ROWS + 1)
                  for i in range(COLUMNS + 1)]
    for part in (1, 2):
        lines.append(f"*ELEMENT, TYPE=S4, ELSET=SHEET{part}")
        for j in range(ROWS):
            for i in range(COLUMNS):
                ids = [node(part, i, j), node(part, i + 1, j), node(part, i + 1, j + 1), node(part, i, j + 1)]
                lines.append(", ".join(map(str, [1000 * part + COLUMNS * j + i + 1] + (ids[::-1] if part in turned else ids))))
    for part in (1, 2):
        lines += [f"*SHELL SECTION, ELSET=SHEET{part}, MATERIAL=STEEL", f"{THICKNESS}"]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{E_SHEET}, 0.3", "*DENSITY", "7.85E-9"]
    every = [node(part, i, j) for part in (1, 2) for j in range(ROWS + 1) for i in range(COLUMNS + 1)]
    for name, ids in (("EVERY", every), ("FIX", [node(1, 0, j) for j in range(ROWS + 1)]),
                      ("PULL", [node(2, COLUMNS, j) for j in range(ROWS + 1)])):
        lines += [f"*NSET, NSET={name}"] + [", ".join(map(str, ids[k:k + 16])) for k in range(0, len(ids), 16)]
    return "\n".join(lines + ["** HISTORY", "*STEP", "*STATIC", "*BOUNDARY", "EVERY, 3, 6", "FIX, 1, 2", f"PULL, 1, 1, {PULL}", "PULL, 2, 2",
                              "*NODE PRINT, NSET=PULL, TOTALS=ONLY", "RF", "*END STEP", ""])


def blocks(text):
    """(keyword, parameters, data lines), in capitals."""
    out = []
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            words = [w.strip() for w in line[1:].split(",")]
            out.append((words[0].upper(), {w.partition("=")[0].strip().upper(): w.partition("=")[2].strip().upper() for w in words[1:]}, []))
        else:
            out[-1][2].append([f.strip().upper() for f in line.rstrip(",").split(",")])
    return out


def nodes_of(text):
    rows = [row for word, _, data in blocks(text) if word == "NODE" for row in data]
    found = {int(row[0]): tuple(float(x) for x in row[1:4]) for row in rows}
    assert len(found) == len(rows), "a node's number is there twice"
    return found


def elements_of(text, type):
    """{id: (set, nodes)} of a type; fails if any two elements have one number."""
    rows = [(given["TYPE"], given.get("ELSET", ""), row) for word, given, data in blocks(text) if word == "ELEMENT" for row in data]
    assert len({int(row[0]) for _, _, row in rows}) == len(rows), "an element's number is there twice"
    return {int(row[0]): (name, [int(n) for n in row[1:]]) for kind, name, row in rows if kind == type}


def one(found, word, name):
    hits = [(given, data) for w, given, data in found if w == word and given.get("NAME") == name]
    assert len(hits) == 1, f"{len(hits)} *{word} are named {name}"
    return hits[0]


def check_bond(before, after, count, turned, from_middle):
    added = "\n".join(added_lines(before, after))
    nodes_before, nodes, sheets, solids = nodes_of(before), nodes_of(after), elements_of(before, "S4"), elements_of(after, "C3D8")
    assert len(solids) == count, f"{len(solids)} hexahedra instead of {count}"
    triangles = {1: [], 2: []}
    for name, ids in sheets.values():
        q = [nodes[n] for n in ids]
        triangles[int(name[-1])] += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    used, inside = set(), 0 if from_middle else THICKNESS / 2
    for id, (_, corners) in solids.items():
        assert len(set(corners)) == 8 and not set(corners) & set(nodes_before), f"solid {id} has a node that isn't the bond's own"
        used |= set(corners)
        q = [nodes[n] for n in corners]
        for c in range(4):
            for p, (a, b, d) in ((q[c], (q[(c + 1) % 4], q[(c + 3) % 4], q[c + 4])), (q[c + 4], (q[4 + (c + 3) % 4], q[4 + (c + 1) % 4], q[c]))):
                assert dot(cross(minus(a, p), minus(b, p)), minus(d, p)) > 0, f"solid {id} has no volume at a corner"
        for part, face in ((1, q[:4]), (2, q[4:])):
            for p in face:
                near = min(distance_from_triangle(p, *t) for t in triangles[part])
                assert abs(near - inside) < 1e-6, f"a corner of solid {id} is {near} from the middle of sheet {part}"
    assert used == set(nodes) - set(nodes_before), "a new node belongs to no solid"
    set_name = {name for name, _ in solids.values()}
    assert len(set_name) == 1
    set_name = set_name.pop()
    new = blocks("*BEFORE\n" + added)  # the new nodes stand behind old ones
    words = [word for word, _, _ in new]
    assert words.index("ELEMENT") < words.index("SOLID SECTION"), "CalculiX wants a set before what names it"
    section = [given for word, given, _ in new if word == "SOLID SECTION"]
    assert len(section) == 1 and section[0]["ELSET"] == set_name
    one(new, "MATERIAL", section[0]["MATERIAL"])
    at = words.index("ELASTIC")
    assert [float(x) for x in new[at][2][0]] == [E_GLUE, NU_GLUE]
    ties = [(given, data) for word, given, data in new if word == "TIE"]
    assert len(ties) == 2
    for (given, data), face, part in zip(ties, ("S1", "S2"), (1, 2)):
        assert given["ADJUST"] == "NO" and abs(float(given["POSITION TOLERANCE"]) - 0.6 * THICKNESS) < 1e-12
        (dependent, main), = data
        assert one(new, "SURFACE", dependent)[1] == [[set_name, face]]
        side = "SPOS" if (part == 1) != (part in turned) else "SNEG"
        assert one(new, "SURFACE", main)[1] == [[f"SHEET{part}", side]], (one(new, "SURFACE", main), side)
    end = [word for word, _, _ in blocks(after)].index("STEP")
    assert all(word != "TIE" for word, _, _ in blocks(after)[end:]), "model data stand behind the first step"
    print(f"  {count} hexahedra with {len(used)} nodes between two sheets; {len(added.splitlines())} lines added, the others as before")


def check_welds(before, after, count):
    added = added_lines(before, after)
    nodes_before, nodes, welds, used = nodes_of(before), nodes_of(after), elements_of(after, "CONN3D2"), set()
    assert len(welds) == count, f"{len(welds)} connectors instead of {count}"
    for id, (_, ends) in welds.items():
        assert len(set(ends)) == 2 and not set(ends) & (set(nodes_before) | used), f"weld {id} has a node that isn't its own"
        used |= set(ends)
        (x, y, z), (u, v, w) = (nodes[n] for n in ends)
        assert abs(x - u) < 1e-6 and abs(y - v) < 1e-6 and sorted((round(z, 6), round(w, 6))) == [0, THICKNESS + GAP]
    assert used == set(nodes) - set(nodes_before), "a new node belongs to no weld"
    name, = {name for name, _ in welds.values()}
    new = blocks("*BEFORE\n" + "\n".join(added))
    assert [(given["ELSET"], data) for word, given, data in new if word == "CONNECTOR SECTION"] == [(name, [["BEAM"]])]
    (fastener, data), = [(given, data) for word, given, data in new if word == "FASTENER"]
    assert fastener["ELSET"] == name and fastener["INTERACTION NAME"]
    assert float(one(new, "FASTENER PROPERTY", fastener["PROPERTY"])[1][0][0]) == 3, "half the diameter is the radius"
    assert data[0] == [""] and len(data) == 2 and len(data[1]) == 1, "the normal is the direction of projection"
    assert sorted(row[0] for row in one(new, "SURFACE", data[1][0])[1]) == ["SHEET1", "SHEET2"]
    print(f"  {count} welds with {len(used)} nodes on two sheets; {len(added)} lines added, the others as before")


def force_through(path):
    """The reaction at the pulled end, by CalculiX."""
    job = os.path.splitext(path)[0]
    done = subprocess.run(["ccx", os.path.basename(job)], cwd=os.path.dirname(path), capture_output=True, text=True)
    assert done.returncode == 0 and "*ERROR" not in done.stdout, done.stdout[-2000:]
    assert "no tied MPC" not in done.stdout, "CalculiX leaves a node untied"
    text = read(job + ".dat")
    return float(re.search(r"set PULL.*?\n\s*\n\s*(\S+)", text).group(1))


def lap_joint(thick):
    """The force at the pulled end: the bare ends stretch, and along the bond w'' = 2 k / EA w for the slip w of the sheets."""
    length, width = SIDE * COLUMNS, SIDE * ROWS
    stretch = E_SHEET * width * THICKNESS
    shear = E_GLUE / (2 * (1 + NU_GLUE)) * WIDTH / thick
    bonded = length - 2 * END
    decay = math.sqrt(2 * shear / stretch)
    compliance = 2 * END / stretch + bonded / (2 * stretch) + 1 / (stretch * decay * math.tanh(decay * bonded / 2))
    return PULL / compliance


def main():
    programs = sys.argv[1:3]
    folder = tempfile.mkdtemp(prefix="prismesh-abaqus-")
    has_solver = shutil.which("ccx") is not None
    try:
        cases = (("flat", deck(), BOND, (), GAP), ("turned", deck((1, 2)), BOND, (1, 2), GAP),
                 ("middles", deck((2,), 0.0), dict(BOND, **{"from": "middles"}), (2,), THICKNESS))
        for name, text, edit, turned, thick in cases:
            path = os.path.join(folder, name, "deck.inp")
            os.makedirs(os.path.dirname(path))
            with open(path, "w", newline="") as file:
                file.write(text)
            out = os.path.join(folder, name, "out", "bonded.inp")
            done = subprocess.run([programs[0], "edit", path, "--edit", json.dumps(edit), "-o", out, "--json"], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr[-2000:]
            said = json.loads(done.stdout.splitlines()[0])
            assert said["solids_left"] == 0 and said["solids_added"] == 6, said
            print(f"{name}:")
            after = read(out)
            check_bond(text, after, 6, turned, name == "middles")
            again = subprocess.run([programs[0], "info", out, "--json"], capture_output=True, text=True, check=True)
            assert json.loads(again.stdout)["elements"]["solid"] == 6
            if has_solver:
                apart, force, wanted = force_through(path), force_through(out), lap_joint(thick)
                assert abs(apart) < 1e-6 * wanted, f"without a bond {apart} goes through"
                assert abs(force - wanted) < 0.03 * wanted, f"the force is {force}, of a lap joint {wanted}"
                print(f"  CalculiX: {force:.1f} goes through the bond, by shear lag {wanted:.1f}; without it {apart:.1e}")
            if name == "flat":
                prove_session(programs, os.path.join(folder, "session"), path, [edit], after)
        path, out = os.path.join(folder, "flat", "deck.inp"), os.path.join(folder, "welded.inp")
        edits = [{"edit": "weld", "flange": {"between": "1,2"}, "pitch": 15, "diameter": 6},
                 {"edit": "weld", "points": [[15, 5, 0], [40, 14, 1]], "like": "spring:1"}]
        script = os.path.join(folder, "welds.jsonl")
        with open(script, "w") as file:
            file.writelines(json.dumps(edit) + "\n" for edit in edits)
        subprocess.run([programs[0], "edit", path, "--script", script, "-o", out], capture_output=True, check=True)
        print("welds:")
        check_welds(deck(), read(out), 6)
        faults = subprocess.run([programs[0], "welds", out, "--json"], capture_output=True, text=True, check=True)
        assert json.loads(faults.stdout) == {"welds": 6, "findings": []}, faults.stdout
        prove_session(programs, os.path.join(folder, "welding"), path, edits, read(out))
        if not has_solver:
            print("ccx isn't installed: nobody ran the decks")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
