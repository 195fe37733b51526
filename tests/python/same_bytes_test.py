#!/usr/bin/env python3
"""Every real deck that PRISMESH_MODELS points to: the same edits, reports and bytes from Python as from `prismesh edit`.

    same_bytes_test.py FOLDER_OF_THE_PACKAGE PRISMESH [DECK..]

DECK: names in counts.json. Without: all but two slow ones; with PRISMESH_ALL_DECKS=1 all. Exit status 77 where there are no models: the test is
skipped.
"""
import json
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import decks  # noqa: E402
import numpy as np  # noqa: E402
import prismesh  # noqa: E402

SLOW = {"bwb_saero", "gsa_car6_comma"}  # their repairs last: 50 and 7 seconds, from Python and the program together


def script_for(state):
    """Edits of a patch of some shell, of sizes that suit it; of a deck without shells, edits of what it has."""
    if len(state.node_ids) == 0:
        return []
    edits = [{"edit": "select", "expr": str(int(np.asarray(state.node_ids)[0])), "kind": "node"}]
    there = np.flatnonzero(np.asarray(state.shell_nodes)[:, 0] != 0xFFFFFFFF)
    if there.size:
        shell = int(there[there.size // 3])
        first, second = np.asarray(state.positions)[np.asarray(state.shell_nodes)[shell, :2]]
        size = float(np.linalg.norm(second - first)) or 1.0
        edits = [
            {"edit": "select", "expr": str(int(np.asarray(state.shell_ids)[shell])), "kind": "element"},
            {"edit": "grow", "rings": 3},
            {"edit": "lift", "distance": size / 3},
            {"edit": "translate", "by": [size / 7, size / 11, -size / 5], "falloff": {"profile": "linear", "flat": 0.25}},
            {"edit": "relax", "mode": "full"},
            {"edit": "repair", "scope": "damaged"},
            {"edit": "undo"},
            {"edit": "redo"},
        ]
    return edits + [{"edit": "translate", "by": [0.1, -0.2, 1 / 3], "falloff": {"profile": "constant"}}]


def by_python(deck, edits, target):
    """Reports, and the sentence of the refusal or None."""
    reports = []
    with prismesh.open(deck) as document:
        for edit in edits:
            try:
                reports.append(document.edit(edit))
            except prismesh.Error as refused:
                return reports, refused
        try:
            document.save(target)
        except prismesh.Error as refused:
            return reports, refused
    return reports, None


def faults_of(name, deck):
    """What differs, as sentences; and how many edits were done, or None where both refuse the deck."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            with prismesh.open(deck) as document:
                edits = script_for(document.state)
        except prismesh.Error as refused:
            status, _, said = decks.program("info", deck)
            return ([] if status == 1 and refused.message in said else [f"{name}: only Python refuses it: {refused}"]), None
        script = os.path.join(folder, "script.jsonl")
        reports, refused = by_python(deck, edits, os.path.join(folder, "python", os.path.basename(deck)))
        with open(script, "w", encoding="utf-8") as file:
            file.writelines(json.dumps(edit) + "\n" for edit in edits)
        status, out, said = decks.program("edit", deck, "--script", script, "-o", os.path.join(folder, "program", os.path.basename(deck)), "--json")
        faults = []
        if (status == 0) != (refused is None) or (refused is not None and refused.message not in said):
            faults.append(f"{name}: Python says {refused}; the program ends with {status}: {said[-300:]}")
        by_program = [report for report in map(json.loads, out.splitlines()) if report["ok"]]
        if decks.without_time(reports) != decks.without_time(by_program):
            faults.append(f"{name}: the reports differ")
        files = decks.files_of(os.path.join(folder, "python"))
        if files != decks.files_of(os.path.join(folder, "program")) or bool(files) != (refused is None):
            faults.append(f"{name}: the files differ")
        return faults, len(reports) if refused is None else -1


def main(names):
    models = os.environ.get("PRISMESH_MODELS", "")
    if not os.path.exists(os.path.join(models, "counts.json")):
        print("PRISMESH_MODELS names no folder with counts.json: THE REAL DECKS ARE NOT TESTED")
        return 77
    with open(os.path.join(models, "counts.json"), encoding="utf-8") as file:
        all_decks = {name: os.path.join(models, deck["main"]) for name, deck in json.load(file).items()}
    if not names:
        everything = os.environ.get("PRISMESH_ALL_DECKS") == "1"
        names = [name for name in all_decks if everything or name not in SLOW]
    faults, saved = [], 0
    for name in names:
        found, edits = faults_of(name, all_decks[name])
        faults += found
        saved += edits is not None and edits > 0
        print(f"{name}: {'REFUSED BY BOTH' if edits is None else 'an edit or the save refused by both' if edits < 0 else f'{edits} edits, the same bytes'}"
              if not found else f"{name}: FAULT")
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{len(names)} of {len(all_decks)} decks, {saved} edited and saved")
    return 1 if faults or saved <= len(names) / 2 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
