#!/usr/bin/env python3
"""A part exchanged for a finer variant, by a script that reads the decks' text alone. The session is killed, recovered, undone and saved.

    replace_proof.py PRISMESH PRISMESH_MODELD

A floor of 10 mm shares an edge with a sill, lies under a lid, has two welds by position, a rigid body, a single constraint, segments and sets.
It gets a mesh of 5 mm, turned and moved away, which three points bring back; the variant's numbers are partly taken.
1. `prismesh edit`: the new part has just the variant's shells at their places; numbers that were free are kept; sets, rigid body, segments and the
   sill's nodes name what lies where the old ones lay; all cards of other parts are there, word for word; no number is there twice.
2. The same edit in modeld, which is killed (SIGKILL), with the variant's file gone: recovered, it saves the same bytes; undone, the deck's.
3. On a deck that nobody vouches for, variant and new text go through other processes: the same bytes.
4. The journal, replayed without the variant's file, gives the same bytes.
5. Parts of real decks (PRISMESH_MODELS), exchanged for themselves, give the decks' bytes.
"""
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from weld_proof import Modeld, columns, nodes_of, shells_of  # noqa: E402

X, Y = 120.0, 60.0


def grid(first, nx, ny, y0, size, z):
    return {(i, j): (first + j * (nx + 1) + i, i * size, y0 + j * size, z) for j in range(ny + 1) for i in range(nx + 1)}


def node_card(node):
    return "%8d%16s%16s%16s" % (node[0], *(repr(round(float(x), 9)) for x in node[1:]))


def shell_cards(first, part, nodes, nx, ny):
    corners = [((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)) for j in range(ny) for i in range(nx)]
    return [("%8d" * 6) % (first + e, part, *(nodes[k][0] for k in c)) for e, c in enumerate(corners)]


def tens(*values):
    return "".join("%10s" % v for v in values)


def id_lines(ids):
    return [tens(*ids[k:k + 8]) for k in range(0, len(ids), 8)]


def car():
    floor, sill, lid = grid(1001, 12, 6, 0, 10, 0), grid(2001, 12, 2, -20, 10, 0), grid(3001, 12, 6, 0, 10, 1.5)
    sill |= {(i, 2): floor[(i, 0)] for i in range(13)}
    edge = [floor[(i, 6)][0] for i in range(13)]
    hole = [floor[k][0] for k in ((3, 2), (4, 2), (4, 3), (3, 3))]
    spots = [(80001, 55, 35, 0), (80002, 55, 35, 1.5), (80003, 103, 52, 0), (80004, 103, 52, 1.5)]
    lines = ["*KEYWORD", "$ the body", "*PART", "floor", tens(1, 1, 1), "*PART", "sill", tens(2, 1, 1), "*PART", "lid", tens(3, 1, 1),
             "*PART", "spots", tens(90, 90, 90), "*SECTION_SHELL", tens(1, 2), tens(1.5, 1.5, 1.5, 1.5), "*SECTION_BEAM", tens(90, 9, 1.0, 2),
             tens(6.0, 6.0), "*MAT_ELASTIC", tens(1, "7.85E-9", "210000.0", 0.3), "*MAT_SPOTWELD", tens(90, "7.85E-9", "210000.0", 0.3, 300.0),
             "*NODE", *map(node_card, floor.values()), "*NODE", *(node_card(n) for k, n in sill.items() if k[1] < 2), *map(node_card, lid.values()),
             *map(node_card, spots), "*ELEMENT_SHELL", *shell_cards(1, 1, floor, 12, 6), *shell_cards(101, 2, sill, 12, 2),
             *shell_cards(201, 3, lid, 12, 6), "*ELEMENT_BEAM", ("%8d" * 4) % (90001, 90, 80001, 80002), ("%8d" * 4) % (90002, 90, 80003, 80004),
             "*SET_NODE_LIST", tens(11), *id_lines([n[0] for n in floor.values()]), "*SET_SHELL_LIST", tens(12), *id_lines(list(range(1, 73))),
             "*SET_NODE_LIST", tens(13), *id_lines(edge), "*SET_NODE_LIST", tens(14), *id_lines(hole),
             "*SET_SHELL_LIST", tens(16), *id_lines([1, 2, 13, 14]), "*CONSTRAINED_NODAL_RIGID_BODY", tens(500, 0, 14),
             "*INITIAL_VELOCITY", tens(11, 0), tens(5.0, 0.0, 0.0), "*BOUNDARY_SPC_NODE", tens(floor[(0, 6)][0], 0, 1, 1, 1),
             "*SET_SEGMENT", tens(15), *(tens(*(floor[k][0] for k in ((i, 0), (i + 1, 0), (i + 1, 1), (i, 1)))) for i in range(3)),
             "*CONTACT_AUTOMATIC_SINGLE_SURFACE", tens(1, 0, 3, 0), "", "", "*END"]
    return "\n".join(lines) + "\n"


def place(node):
    """Where the variant stands in its own deck: turned by 30 degrees about z, and moved."""
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    return (node[0], c * node[1] - s * node[2] + 700, s * node[1] + c * node[2] - 300, node[3] + 25)


def variant():
    new = grid(901, 24, 12, 0, 5, 0)  # 901 to 1225: from 1001 on those of the old floor
    lines = ["*KEYWORD", "*PART", "new floor", tens(7, 1, 1), "*PART", "another", tens(8, 1, 1), "*SECTION_SHELL", tens(1, 2), tens(1.2, 1.2, 1.2, 1.2),
             "*MAT_ELASTIC", tens(1, "7.85E-9", "210000.0", 0.3), "*NODE", *(node_card(place(n)) for n in new.values()),
             *(node_card(place((5001 + i, 10 * (i % 2), 10 * (i // 2), 90))) for i in range(4)),
             "*ELEMENT_SHELL", *shell_cards(1, 7, new, 24, 12), ("%8d" * 6) % (9001, 8, 5001, 5002, 5004, 5003), "*END"]
    return "\n".join(lines) + "\n", new


def sets_of(text, keyword):
    """Numbers of each block with this keyword, by the set's own."""
    found = {}
    for block in re.split(r"^(?=\*)", text, flags=re.M):
        lines = [l for l in block.splitlines() if not l.startswith("$")]
        if lines and lines[0].strip() == keyword:
            found[int(columns(lines[1], (10,))[0])] = [int(x) for l in lines[2:] for x in columns(l, (10,) * 8) if x and int(x)]
    return found


def near(a, b, tolerance=1e-6):
    return max(abs(x - y) for x, y in zip(a, b)) <= tolerance


def check(before, after, new):
    shells, old_nodes, old_shells = shells_of(after), nodes_of(before), shells_of(before)
    nodes = {id: tuple(round(x, 5) + 0.0 for x in at) for id, at in nodes_of(after).items()}  # turned and back: some last digits differ
    floor = {id: ids for id, (part, ids) in shells.items() if part == 1}
    assert len(floor) == 288, f"{len(floor)} shells in the part instead of 288"
    for keyword in ("*NODE", "*ELEMENT_SHELL"):
        ids = [columns(l, (8,))[0] for block in re.split(r"^(?=\*)", after, flags=re.M) if block.split("\n")[0].strip() == keyword
               for l in block.splitlines()[1:] if not l.startswith("$")]
        assert len(ids) == len(set(ids)), f"a number under {keyword} is there twice"

    # the variant's mesh, at the places where it belongs
    corners = sorted(tuple(sorted(nodes[n] for n in ids)) for ids in floor.values())
    wanted = sorted(tuple(sorted((5.0 * i + a, 5.0 * j + b, 0.0) for a in (0, 5) for b in (0, 5))) for j in range(12) for i in range(24))
    assert corners == wanted, "the part isn't the variant"
    used = {n for ids in floor.values() for n in ids}

    # numbers: kept unless another node had it, or the new node took the place of one that something names
    kept = renumbered = 0
    others = {n for part, ids in old_shells.values() if part != 1 for n in ids}
    at_place = {nodes[n]: n for n in used}
    named = others | {n for ids in (sets_of(before, "*SET_NODE_LIST")[s] for s in (13, 14)) for n in ids}
    free = set(range(901, 1001))
    for id, x, y, z in new.values():
        now = at_place[(x, y, z)]
        kept += now == id
        if now == id:
            continue
        renumbered += 1
        old_here = [n for n in named if near(old_nodes[n], (x, y, z))]
        assert old_here == [now] or id not in free or any(near(old_nodes[n], (x, y, z)) for n in named), f"node {id} became {now} without a reason"
    assert kept >= 100 - 30, f"only {kept} of the variant's numbers are kept"

    # connections by position
    sill = {n for part, ids in shells.values() if part == 2 for n in ids}
    assert {nodes[n] for n in sill & used} == {(10.0 * i, 0.0, 0.0) for i in range(13)}, "the sill isn't joined"
    node_sets, shell_sets = sets_of(after, "*SET_NODE_LIST"), sets_of(after, "*SET_SHELL_LIST")
    assert sorted(node_sets[11]) == sorted(used), "the set of all nodes isn't that of the new ones"
    assert sorted(shell_sets[12]) == sorted(floor), "the set of all shells isn't that of the new ones"
    assert {nodes[n] for n in node_sets[13]} == {(5.0 * i, Y, 0.0) for i in range(25)}, "the row along the edge"
    assert {nodes[n] for n in node_sets[14]} == {(30 + 5.0 * i, 20 + 5.0 * j, 0.0) for i in range(3) for j in range(3)}, "the rigid body"
    centres = {e: tuple(sum(nodes[n][k] for n in ids) / 4 for k in (0, 1)) for e, ids in floor.items()}
    assert sorted(shell_sets[16]) == sorted(e for e, c in centres.items() if c[0] < 20 and c[1] < 20), "the set of four shells"
    segments = {tuple(sorted(sets_of(after, "*SET_SEGMENT")[15][k:k + 4])) for k in range(0, len(sets_of(after, "*SET_SEGMENT")[15]), 4)}
    assert segments == {tuple(sorted(ids)) for e, ids in floor.items() if centres[e][0] < 30 and centres[e][1] < 10}, "the segments"
    held = int(columns(after.split("*BOUNDARY_SPC_NODE\n")[1], (10,))[0])
    assert near(nodes[held], (0, Y, 0)), "the constraint holds another place"

    # everything else, word for word
    of_floor = {id for id, (part, _) in old_shells.items() if part == 1}
    own = {n for e in of_floor for n in old_shells[e][1]} - others
    gone, now, at = [], after.splitlines(), 0
    for line in before.splitlines():
        try:
            at = now.index(line, at) + 1
        except ValueError:
            gone.append(line)
    for line in gone:
        number = columns(line, (8,))[0]
        is_own = number.isdigit() and (int(number) in own or int(number) in of_floor)
        assert is_own or set(line) <= set("0123456789 "), f"a line is gone: {line!r}"
    assert set(nodes) == (set(old_nodes) - own) | used, "a node is left over, or another is gone"
    print(f"  {len(floor)} shells, {kept} numbers kept, {renumbered} others; {len(gone)} lines of the deck changed")


def same_again(prismesh, folder):
    """Parts of real decks, exchanged for themselves: the decks' bytes."""
    models = os.environ.get("PRISMESH_MODELS", "")
    decks = (("hatprofile/Hatprofile.k", (1, 2)), ("joint_screw/EXP_SC_JOINT_SCREW.key", (1000003, 1000004)),
             ("seat_adyrel_rad/SEAT_ADYREL_0000.rad", (22, 28)), ("bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", (9, 20)))
    for name, parts in decks:
        source = os.path.join(models, name)
        if not os.path.exists(source):
            print(f"no {name}: skipped")
            continue
        out = os.path.join(folder, "again", os.path.basename(name))
        for part in parts:
            edit = json.dumps({"edit": "replace_part", "part": part, "deck": os.path.basename(name), "with": part})
            done = subprocess.run([prismesh, "edit", source, "--edit", edit, "-o", out, "--json"], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr[-2000:]
            report = json.loads(done.stdout.splitlines()[0])
            assert report["elements_added"] > 0 and report["lost_connections"] == 0, report
            assert open(out, "rb").read() == open(source, "rb").read(), f"part {part} of {name}, exchanged for itself, is another deck"
        print(f"{name}: parts {parts} exchanged for themselves: the same bytes")


def main():
    prismesh, modeld = sys.argv[1:3]
    folder = tempfile.mkdtemp(prefix="prismesh-replace-")
    read = lambda path: open(path, newline="").read()  # noqa: E731
    try:
        deck = os.path.join(folder, "deck", "car.k")
        os.makedirs(os.path.dirname(deck))
        before = car()
        text, new = variant()
        for path, content in ((deck, before), (os.path.join(folder, "deck", "variant.k"), text)):
            with open(path, "w", newline="") as file:
                file.write(content)
        edit = json.dumps({"edit": "replace_part", "part": 1, "deck": "variant.k", "with": 7,
                           "align": [[901, 925, 1201], [1001, [X, 0, 0], 1079]]})
        out = os.path.join(folder, "out", "car.k")
        done = subprocess.run([prismesh, "edit", deck, "--edit", edit, "-o", out, "--json"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr[-2000:]
        report = json.loads(done.stdout.splitlines()[0])
        assert report["lost_connections"] == 12, report  # the nodes between those of the sill
        after = read(out)
        check(before, after, new)
        print("exchanged by the command line: the part's cards, its sets and connections")

        daemon = Modeld(modeld, prismesh, folder)
        daemon.session("open", deck)
        daemon.session("edit", edit)
        daemon.kill(signal.SIGKILL)
        os.rename(os.path.join(folder, "deck", "variant.k"), os.path.join(folder, "variant.k"))
        other = os.path.join(folder, "other")
        shutil.copytree(os.path.join(folder, "state"), os.path.join(other, "state"))
        journal = next(os.path.join(base, name) for base, _, names in os.walk(os.path.join(other, "state")) for name in names
                       if "replace_part" in open(os.path.join(base, name), errors="replace").read())
        replayed = os.path.join(folder, "replayed", "car.k")
        subprocess.run([prismesh, "replay", journal, deck, "-o", replayed], check=True, capture_output=True)
        assert read(replayed) == after, "replayed, another deck is saved"
        print("replayed without the variant's file: the same bytes are saved")
        daemon = Modeld(modeld, prismesh, folder)
        daemon.session("open", deck)
        recovered = os.path.join(folder, "recovered", "car.k")
        daemon.session("save", recovered)
        daemon.kill(signal.SIGTERM)
        assert read(recovered) == after, "recovered, another deck is saved"
        print("killed and recovered without it: the same bytes are saved")
        daemon = Modeld(modeld, prismesh, other)
        daemon.session("open", deck)
        daemon.session("undo")
        undone = os.path.join(folder, "undone", "car.k")
        daemon.session("save", undone)
        daemon.kill(signal.SIGTERM)
        assert read(undone) == before, "undone, another deck is saved"
        print("undone: the original's bytes are saved")
        os.rename(os.path.join(folder, "variant.k"), os.path.join(folder, "deck", "variant.k"))
        daemon = Modeld(modeld, prismesh, os.path.join(folder, "third"))
        daemon.session("open", "--sandboxed", deck)
        daemon.session("edit", edit)
        rewritten = os.path.join(folder, "rewritten", "car.k")
        daemon.session("save", rewritten)
        daemon.kill(signal.SIGTERM)
        assert read(rewritten) == after, "read and rewritten in a sandbox, another deck is saved"
        print("read and rewritten in a sandbox: the same bytes are saved")
        same_again(prismesh, folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
