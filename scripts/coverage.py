"""Prints what tests reach of modules, from the JSON that llvm-cov exports: figures of each module, then the error branches that no test takes and that
have no reason in the list of reasons. Writes every branch that goes one way only into a separate file.

usage: coverage.py EXPORT.json REASONS.txt ONE_WAY.txt MODULE..   (a folder or the beginning of a file's path, as in base/file)

A line of the list of reasons is `FILE: CONDITION => REASON`, with the condition or statement as printed here; it holds for all equal ones in that file.
"""

import json
import os
import re
import sys

from error_branches import SAYS_ERROR, ErrorBranches


class Unreached:
    """A branch or statement that no test takes."""

    def __init__(self, path, line, how, text):
        self.path, self.line, self.how, self.text = path, line, how, re.sub(r"\s+", " ", text).strip()

    def key(self):
        return f"{self.path}: {self.text}"

    def __str__(self):
        return f"{self.path}:{self.line}: {self.how}: {self.text}"


def main():
    export, reasons_path, one_way_path, modules = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    with open(export, encoding="utf-8") as file:
        files = json.load(file)["data"][0]["files"]
    ours = {of_the_project(entry["filename"]): entry for entry in files}
    reasons = read_reasons(reasons_path)
    one_way, still_open, used = [], [], set()
    print(f"{'module':20} {'lines':>18} {'branches':>18} {'error branches':>18} {'with a reason':>14} {'open':>6}")
    for module in modules:
        inside = [(path, entry) for path, entry in sorted(ours.items()) if belongs(path, module)]
        total, errors = 0, []
        for path, entry in inside:
            all_one_way, of_errors, count = unreached(path, entry)
            one_way += all_one_way
            errors += of_errors
            total += count
        without = [one for one in errors if one.key() not in reasons]
        used.update(one.key() for one in errors)
        still_open += without
        entries = [entry for _, entry in inside]
        print(f"{module:20} {share(entries, 'lines')} {share(entries, 'branches')} {part(total - len(errors), total)}"
              f" {len(errors) - len(without):>14} {len(without):>6}")
    for one in still_open:
        print(one)
    for key in reasons:
        if key not in used and any(belongs(key.split(": ")[0], module) for module in modules):
            print(f"{reasons_path}: no longer an untested error branch: {key}")
    with open(one_way_path, "w", encoding="utf-8") as file:
        file.writelines(f"{one}\n" for one in one_way)


def read_reasons(path):
    with open(path, encoding="utf-8") as file:
        lines = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    return dict(line.split(" => ", 1) for line in lines)


def of_the_project(path):
    """A file's path from the project's root. Sources that are compiled in batches have paths in the build folder."""
    path = os.path.relpath(os.path.normpath(path))
    return path.removeprefix("build/coverage/")


def belongs(path, module):
    """Whether a file belongs to a module: in its folder, or the file itself with any extension."""
    return path.startswith(module + "/") or os.path.splitext(path)[0] == module


def share(entries, what):
    return part(sum(entry["summary"][what]["covered"] for entry in entries), sum(entry["summary"][what]["count"] for entry in entries))


def part(covered, count):
    return f"{covered:>6}/{count:<6} {100 * covered / max(count, 1):5.1f}%".rjust(18)


def unreached(path, entry):
    """The branches of a file that go one way only, those of them that lead to an error, and the number of all branches that lead to one.

    Branches of a template or inline function count together: each instance is listed once.
    """
    with open(path, encoding="utf-8") as file:
        source = file.read()
    lines = source.split("\n")
    branches = ErrorBranches(source)
    one_way, errors, count, listed = [], [], 0, []
    for (line, column, end_line, end_column), (taken, not_taken) in sorted(ways(entry).items()):
        way = branches.way_to_error(line, column)
        count += way is not None
        if taken and not_taken:
            continue
        how = "never evaluated" if not taken and not not_taken else "never true" if not taken else "never false"
        last = end_column - 1 if end_line == line else None
        one = Unreached(path, line, how, lines[line - 1][column - 1 : last])
        one_way.append(one)
        if way is not None and not (taken if way else not_taken):
            errors.append(one)
            listed.append(branches.place(line, column))
    for start, end in untaken_regions(entry):
        guards = branches.guarded_by(*start)
        if any(opening < place < closing for opening, closing in guards for place in listed):
            continue
        text = branches.text[branches.place(*start) : branches.place(*end)]
        said = SAYS_ERROR.search(text)
        if said:
            line = start[0] + text[: said.start()].count("\n")
            errors.append(Unreached(path, line, "never run", lines[line - 1]))
            count += 1
    return one_way, errors, count


def ways(entry):
    """How often each condition was true and false, by its place."""
    found = {}
    for line, column, end_line, end_column, taken, not_taken, *_ in entry["branches"]:
        before = found.get((line, column, end_line, end_column), (0, 0))
        found[line, column, end_line, end_column] = (before[0] + taken, before[1] + not_taken)
    return found


def untaken_regions(entry):
    """Where a region begins and ends that no test runs, up to the next region."""
    for (line, column, count, counted, begins, gap), following in zip(entry["segments"], entry["segments"][1:]):
        if counted and begins and not gap and count == 0:
            yield (line, column), following[:2]


main()
