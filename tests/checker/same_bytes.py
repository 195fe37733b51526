#!/usr/bin/env python3
"""Two builds of the program edit every real deck that PRISMESH_MODELS points to: all they write must be the same, byte for byte.

    same_bytes.py PRISMESH OTHER_PRISMESH [--threads] [DECK..]

DECK: names in counts.json, all without. --threads: the first build on one processor only, the other on all.
For before and after a change that must not be seen: of names, of the build, of the compiler's options.
Exit status 77 where there are no models: the test is skipped.
"""
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import check_deck  # noqa: E402

SHELL_NAMES = {"shell", "sh3n"}
# Repairing the largest decks takes minutes.
MAX_SHELLS_TO_REPAIR = 60_000


def edits_of(deck):
    """Lists of edits by name: one of each kind, about a node of some shell."""
    sessions = {"nothing": []}
    shells = [e for e in deck.elements if 3 <= len(e.nodes) <= 8 and all(n in deck.nodes for n in e.nodes[:3])]
    if not shells:
        return sessions
    middle = shells[len(shells) // 2]
    node = middle.nodes[0]
    at = deck.nodes[node].basic()
    size = max(max(abs(a - b) for a, b in zip(at, deck.nodes[n].basic())) for n in middle.nodes[1:3]) or 1.0
    region = {"edit": "select_region", "at": list(at), "angle": 40}
    sessions["pull"] = [region, {"edit": "grow", "rings": 2},
                        {"edit": "translate", "by": [0.31 * size, -0.17 * size, 0.73 * size], "falloff": {"profile": "gaussian"}},
                        {"edit": "lift", "distance": 0.4 * size, "normals": "each"},
                        {"edit": "slide", "by": [0.2 * size, 0, 0]},
                        {"edit": "rotate", "point": list(at), "axis": [0.1, 0.2, 1], "degrees": 3}]
    sessions["relax"] = [{"edit": "translate", "by": [0.3 * size, 0.2 * size, 0], "on": str(node)}, {"edit": "relax", "scope": "part"}]
    if len(shells) <= MAX_SHELLS_TO_REPAIR:
        sessions["repair"] = [{"edit": "translate", "by": [0.4 * size, 0.3 * size, 1.1 * size], "on": str(node)}, {"edit": "repair"}]
    return sessions


def run(program, main, edits, folder):
    """What the program said (without times) and the hash of each file it wrote, by name."""
    command = [*program, "edit", main, "-o", os.path.join(folder, os.path.basename(main)), "--json"]
    for edit in edits:
        command += ["--edit", json.dumps(edit)]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace")
    said = re.sub(r'"ms": ?[0-9.e+-]+', '"ms":0', done.stdout) + done.stderr.replace(folder, "")
    files = {}
    for parent, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(parent, name)
            with open(path, "rb") as file:
                files[os.path.relpath(path, folder)] = hashlib.sha256(file.read()).hexdigest()
    return done.returncode, said.replace(folder, ""), files


def main(arguments):
    threads = "--threads" in arguments
    arguments = [a for a in arguments if a != "--threads"]
    if len(arguments) < 2:
        print(__doc__)
        return 2
    models = os.environ.get("PRISMESH_MODELS")
    if not models or not os.path.isfile(os.path.join(models, "counts.json")):
        print("skipped: PRISMESH_MODELS names no folder with counts.json")
        return 77
    with open(os.path.join(models, "counts.json"), encoding="utf-8") as file:
        known = json.load(file)
    one, other = [arguments[0]], [arguments[1]]
    if threads:
        one = ["taskset", "-c", str(min(os.sched_getaffinity(0))), *one]
    compared = written = edited = different = 0
    for name in arguments[2:] or sorted(known):
        main_file = os.path.join(models, known[name]["main"])
        try:
            sessions = edits_of(check_deck.read(main_file))
        except Exception as problem:  # what the checker can't read is compared unedited
            print(f"{name}: not edited, the checker says: {problem}")
            sessions = {"nothing": []}
        for what, edits in sessions.items():
            with tempfile.TemporaryDirectory() as a, tempfile.TemporaryDirectory() as b:
                mine, theirs = run(one, main_file, edits, a), run(other, main_file, edits, b)
            compared += 1
            written += len(mine[2])
            edited += bool(edits) and mine[0] == 0
            if mine != theirs:
                different += 1
                print(f"DIFFERENT {name}, {what}: status {mine[0]} and {theirs[0]}, files {sorted(f for f in mine[2].keys() | theirs[2].keys() if mine[2].get(f) != theirs[2].get(f))}")
                if mine[1] != theirs[1]:
                    print("  says: " + mine[1][-300:].strip() + "\n  other: " + theirs[1][-300:].strip())
    print(f"{compared} runs, {edited} of them edited, {written} files written: {different} differ")
    return 1 if different or not edited else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
