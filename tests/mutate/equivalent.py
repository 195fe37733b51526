"""Mutants that change no behaviour, as somebody has found out: tests/mutate/equivalent.txt.

A line is `FILE: TEXT BEFORE => TEXT AFTER: REASON`. It holds for every mutant of the file that turns the one text into the other; the texts
are a piece of the lines as the list of slipped mutants shows them.
"""
import os


def read_equivalent(path):
    """A function that tells whether a mutant is on the list."""
    known = []
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            for line in file:
                if " => " not in line or line.startswith("#"):
                    continue
                name, rest = line.split(": ", 1)
                before, after = rest.split(" => ", 1)
                known.append((name, before.strip(), after.rsplit(": ", 1)[0].strip()))

    def is_equivalent(mutant):
        return any(name == mutant.file and before in mutant.before and mutant.before.replace(before, after, 1) == mutant.after
                   for name, before, after in known)

    return is_equivalent
