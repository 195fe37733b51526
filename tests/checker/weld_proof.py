#!/usr/bin/env python3
"""Welds on a real deck, by a script that reads the decks' text alone: 1,000 welds are made, the session is killed, recovered, undone and saved.

    weld_proof.py PRISMESH PRISMESH_MODELD [WORK_FOLDER]

1. `prismesh edit` puts 1,000 welds on the flanges of hatprofile, as a new part. Every line of the deck is still there, in order; each new beam
   has a node on each sheet, which the plane of a shell's text contains; every new number is new.
2. The same welds are made in modeld, which is killed (SIGKILL); recovered, it saves the same bytes; after undo it saves the deck's.
3. Made on the deck as one that nobody vouches for, which another process writes, they are saved as the same bytes.
Exit status 77 where there are no models: the test is skipped.
"""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROWS = 20
WELDS = 1000


def cards(text, keyword):
    """The data lines of all blocks with this keyword."""
    lines, inside = [], False
    for line in text.splitlines():
        if line.startswith("*"):
            inside = line.split()[0].upper() == keyword
        elif inside and not line.startswith("$"):
            lines.append(line)
    return lines


def columns(line, widths):
    at, out = 0, []
    for width in widths:
        out.append(line[at:at + width].strip())
        at += width
    return out


def nodes_of(text):
    return {int(f[0]): tuple(float(x) for x in f[1:4]) for f in (columns(l, (8, 16, 16, 16)) for l in cards(text, "*NODE"))}


def shells_of(text):
    return {int(f[0]): (int(f[1]), [int(n) for n in f[2:6]]) for f in (columns(l, (8,) * 6) for l in cards(text, "*ELEMENT_SHELL"))}


def beams_of(text):
    return {int(f[0]): (int(f[1]), [int(n) for n in f[2:4]]) for f in (columns(l, (8,) * 4) for l in cards(text, "*ELEMENT_BEAM"))}


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def in_triangle(p, a, b, c, tolerance):
    normal = cross(minus(b, a), minus(c, a))
    size = dot(normal, normal) ** 0.5
    if size == 0 or abs(dot(minus(p, a), normal)) / size > tolerance:
        return False
    return all(dot(cross(minus(v, u), minus(p, u)), normal) >= -1e-6 * size * size for u, v in ((a, b), (b, c), (c, a)))


def parts_at(p, cells, nodes, shells, cell):
    """Parts whose shells contain the point, by their text's coordinates."""
    found = set()
    key = (int(p[0] // cell), int(p[1] // cell))
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            for id in cells.get((key[0] + dx, key[1] + dy), ()):
                part, ids = shells[id]
                q = [nodes[n] for n in ids]
                if in_triangle(p, q[0], q[1], q[2], 1e-4) or in_triangle(p, q[0], q[2], q[3], 1e-4):
                    found.add(part)
    return found


def check(before, after, welds):
    old, new = before.splitlines(), after.splitlines()
    added, at = [], 0
    for line in new:
        if at < len(old) and line == old[at]:
            at += 1
        else:
            added.append(line)
    assert at == len(old), f"line {at + 1} of the deck is gone: {old[at]!r}"
    nodes_before, nodes, shells = nodes_of(before), nodes_of(after), shells_of(before)
    beams = {id: beam for id, beam in beams_of(after).items() if id not in beams_of(before)}
    assert len(beams) == welds, f"{len(beams)} new beams instead of {welds}"
    taken = set(nodes_before)
    new_nodes = [int(columns(l, (8,))[0]) for l in cards(after, "*NODE")]
    assert len(new_nodes) == len(set(new_nodes)), "a node's number is there twice"
    ids = [int(columns(l, (8,))[0]) for k in ("*ELEMENT_SHELL", "*ELEMENT_BEAM", "*ELEMENT_SOLID") for l in cards(after, k)]
    assert len(cards(after, "*ELEMENT_BEAM")) == len(set(beams_of(after))), "a beam's number is there twice"
    assert not set(beams) & (set(ids) - set(beams_of(after))), "a beam has the number of another element"
    cell = 10.0
    cells = {}
    for id, (_, corners) in shells.items():
        for n in set(corners):
            x, y, _ = nodes_before[n]
            cells.setdefault((int(x // cell), int(y // cell)), set()).add(id)
    parts_of_beams = {part for part, _ in beams.values()}
    assert len(parts_of_beams) == 1
    used = set()
    for id, (_, ends) in beams.items():
        sheets = []
        for node in ends:
            assert node not in taken and node not in used, f"beam {id} has a node that isn't its own"
            used.add(node)
            sheets.append(parts_at(nodes[node], cells, nodes_before, shells, cell))
        assert sheets[0] and sheets[1] and sheets[0] != sheets[1], f"beam {id} lies on {sheets}, not on two sheets"
    assert used == set(nodes) - taken, "a new node belongs to no weld"
    part = parts_of_beams.pop()
    for keyword in ("*SECTION_BEAM", "*MAT_SPOTWELD", "*SET_PART_LIST", "*CONTACT_SPOTWELD"):
        assert int(columns(cards("\n".join(added), keyword)[0], (10,))[0]) == part, keyword
    print(f"  {len(beams)} beams with {len(used)} nodes on two sheets each; {len(old)} lines as before, {len(added)} added")


def edits():
    """20 rows of 50 welds along the flange at y = 47.5; the first makes the part, the others are like its first weld."""
    out = []
    for row in range(ROWS):
        y = 35.0 + row * 25.0 / (ROWS - 1)
        points = [[5 + 10 * i, y, 1] for i in range(WELDS // ROWS)]
        out.append({"edit": "weld", "points": points, "parts": "1,2"} | ({"like": "?"} if row else {"diameter": 4, "yield_stress": 0.3}))
    return out


class Modeld:
    def __init__(self, program, prismesh, folder):
        self.environment = dict(os.environ, RUNTIME_DIRECTORY=os.path.join(folder, "run"), STATE_DIRECTORY=os.path.join(folder, "state"))
        for name in ("run", "state"):
            os.makedirs(os.path.join(folder, name), exist_ok=True)
        self.prismesh = prismesh
        self.process = subprocess.Popen([program], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def session(self, *arguments):
        for _ in range(100):
            done = subprocess.run([self.prismesh, "session", *arguments], env=self.environment, capture_output=True, text=True)
            if done.returncode == 0 or "nobody listens" not in done.stderr:
                break
            time.sleep(0.1)
        assert done.returncode == 0, done.stderr[-2000:]
        return done.stdout

    def kill(self, with_signal):
        self.process.send_signal(with_signal)
        self.process.wait()


def main():
    models = os.environ.get("PRISMESH_MODELS", "")
    source = os.path.join(models, "hatprofile", "Hatprofile.k")
    if not os.path.exists(source):
        return 77
    prismesh, modeld = sys.argv[1:3]
    folder = tempfile.mkdtemp(prefix="prismesh-welds-")
    try:
        deck = os.path.join(folder, "deck", "hat.k")
        os.makedirs(os.path.dirname(deck))
        shutil.copy(source, deck)
        os.chmod(deck, 0o644)
        before = open(deck, errors="surrogateescape", newline="").read()
        # the first new beam's number, from a first weld alone
        first = os.path.join(folder, "first", "hat.k")
        wanted = edits()
        subprocess.run([prismesh, "edit", deck, "--edit", json.dumps(wanted[0]), "-o", first], check=True, capture_output=True)
        example = min(beams_of(open(first, errors="surrogateescape").read()))
        wanted = [dict(e, like=f"beam:{example}") if e.get("like") else e for e in wanted]
        script = os.path.join(folder, "welds.jsonl")
        with open(script, "w") as file:
            file.writelines(json.dumps(edit) + "\n" for edit in wanted)

        out = os.path.join(folder, "out", "hat.k")
        began = time.monotonic()
        done = subprocess.run([prismesh, "edit", deck, "--script", script, "-o", out, "--json"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr[-2000:]
        made = sum(json.loads(line)["welds_added"] for line in done.stdout.splitlines())
        assert made == WELDS, f"{made} welds"
        print(f"{made} welds by the command line in {time.monotonic() - began:.2f} s")
        after = open(out, errors="surrogateescape", newline="").read()
        check(before, after, WELDS)
        again = subprocess.run([prismesh, "info", out, "--json"], capture_output=True, text=True, check=True)
        assert json.loads(again.stdout)["elements"]["beam"] == WELDS

        daemon = Modeld(modeld, prismesh, folder)
        daemon.session("open", deck)
        daemon.session("edit", "--script", script)
        daemon.kill(signal.SIGKILL)
        # Two sessions go on from what was killed: one saves, the other undoes first.
        other = os.path.join(folder, "other")
        shutil.copytree(os.path.join(folder, "state"), os.path.join(other, "state"))
        daemon = Modeld(modeld, prismesh, folder)
        daemon.session("open", deck)
        recovered = os.path.join(folder, "recovered", "hat.k")
        daemon.session("save", recovered)
        daemon.kill(signal.SIGTERM)
        assert open(recovered, errors="surrogateescape", newline="").read() == after, "recovered, another deck is saved"
        print("killed and recovered: the same bytes are saved")
        daemon = Modeld(modeld, prismesh, other)
        daemon.session("open", deck)
        for _ in wanted:
            daemon.session("undo")
        undone = os.path.join(folder, "undone", "hat.k")
        daemon.session("save", undone)
        daemon.kill(signal.SIGTERM)
        assert open(undone, "rb").read() == open(source, "rb").read(), "undone, another deck is saved"
        print("undone: the original's bytes are saved")
        daemon = Modeld(modeld, prismesh, os.path.join(folder, "third"))
        daemon.session("open", "--sandboxed", deck)
        daemon.session("edit", "--script", script)
        rewritten = os.path.join(folder, "rewritten", "hat.k")
        daemon.session("save", rewritten)
        daemon.kill(signal.SIGTERM)
        assert open(rewritten, errors="surrogateescape", newline="").read() == after, "rewritten in a sandbox, another deck is saved"
        print("rewritten in a sandbox: the same bytes are saved")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
