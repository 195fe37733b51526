"""The list of mutants that no test noticed, and the counts."""
import re
from collections import Counter


def entry(mutant):
    return f"{mutant.file}:{mutant.line}: {mutant.state}: {mutant.kind}\n    - {mutant.before}\n    + {mutant.after}"


def listed(mutants):
    return [entry(mutant) for mutant in mutants if mutant.state == "slipped"] + not_reached(mutants)


def read_slipped(path):
    """(file, before, after) of what slipped through in a list. Lines may have moved since."""
    with open(path, encoding="utf-8") as file:
        found = re.findall(r"^(\S+?):\d+: slipped: .*\n    - (.*)\n    \+ (.*)$", file.read(), re.M)
    return set(found)


def counts(mutants, left_over):
    states = Counter(mutant.state for mutant in mutants)
    made = len(mutants) - states["not compiled"]
    parts = [f"made {made}", f"reached {states['caught'] + states['slipped'] + states['no change of behaviour']}", f"caught {states['caught']}",
             f"slipped {states['slipped']}", f"not reached {states['not reached']}"]
    if states["no change of behaviour"]:
        parts.insert(4, f"no change of behaviour {states['no change of behaviour']}")
    if states["not compiled"]:
        parts.append(f"not compiled {states['not compiled']}")
    if states[""]:
        parts.append(f"not judged for lack of time {states['']}")
    if left_over:
        parts.append(f"not chosen {left_over}")
    return ", ".join(parts)


def not_reached(mutants):
    """Lines that no test reaches, by file."""
    lines = {}
    for mutant in mutants:
        if mutant.state == "not reached":
            lines.setdefault(mutant.file, set()).add(mutant.line)
    return [f"{file}: not reached: {', '.join(str(line) for line in sorted(lines[file]))}" for file in sorted(lines)]
