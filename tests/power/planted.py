#!/usr/bin/env python3
"""Do the power cuts notice? Plants faults of durability into the daemons, one at a time (plants.cpp, loaded into them), and expects that cut.py's
checks find each. Skipped, aloud, without user-mode Linux.

    planted.py PROGRAMS LIBRARY [--only NAME] [--all] [--cuts N] [--images N] [--seed S]     LIBRARY: the built plants.cpp
"""
import argparse
import os
import sys

sys.dont_write_bytecode = True
import machine  # noqa: E402
import session  # noqa: E402

PLANTS = {
    "journal-unflushed": "an edit in the journal is never flushed",
    "new-journal-unflushed": "a new journal is put in place that wasn't flushed",
    "journal-flushed-later": "an edit is acknowledged, and flushed a moment later",
    "journal-half-written": "writing an edit to the journal stops halfway and counts as whole",
    "check-ignored": "the check of a journal's record is ignored",
    "deck-unflushed": "a save puts files in place that it hasn't flushed",
    "deck-removed-first": "a save removes a file before it puts the new one in place",
    "save-unrecorded": "the records of a save are removed before its files are replaced",
    "folder-unflushed": "no folder is ever flushed",
    "content-unflushed": "an upload is published that wasn't flushed",
    "content-half-written": "a write to an upload stops halfway and counts as whole",
    "record-unflushed": "a model's record is put in place that wasn't flushed",
    "record-renamed-later": "a publication is acknowledged, and its record put in place a moment later",
}


def noticed(check):
    """The first sentence of what the check has found; "" if nothing."""
    try:
        wrong = check()[-1]
    except RuntimeError as problem:  # the guest: a step was refused, or a daemon ended
        return "at work: " + str(problem).strip().splitlines()[-1]
    return wrong[0].splitlines()[0] if wrong else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs")
    parser.add_argument("library")
    parser.add_argument("--only", choices=PLANTS)
    parser.add_argument("--cuts", type=int, default=10, help="at most, for each")
    parser.add_argument("--images", type=int, default=250, help="at most, for each")
    parser.add_argument("--all", action="store_true", help="go on with the other check where one has found the fault")
    parser.add_argument("--seed", type=int, default=int(os.environ.get("PRISMESH_SEED", "1")))
    given = parser.parse_args()
    missing = machine.missing()
    if missing:
        print(f"SKIPPED: no fault is planted: {missing} isn't installed")
        return 77
    machine.end_with_this_program()
    slipped = []
    plants = [given.only] if given.only else list(PLANTS)
    for name in plants:
        plant = {"LD_PRELOAD": os.path.realpath(given.library), "PRISMESH_PLANT": name}
        where = {"environment": {"modeld": plant, "intake": plant}, "keep": False}
        print(f"{name}: {PLANTS[name]}")
        checks = {"write cache": lambda: session.try_write_cache(given.programs, given.seed, given.images, **where),
                  "cut power": lambda: session.cut_one_disk(given.programs, given.seed, given.cuts, **where)}
        found = False
        for check, run in checks.items():
            if found and not given.all:
                break
            sentence = noticed(run)
            found = found or bool(sentence)
            print(f"    {check}: {sentence or 'notices nothing'}", flush=True)
        if not found:
            slipped.append(name)
    print(f"{len(plants)} faults planted, {len(plants) - len(slipped)} noticed" + "".join(f"\nFAILED: {name} slipped through" for name in slipped))
    return 1 if slipped else 0


sys.exit(main())
