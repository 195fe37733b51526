"""Prints what tests reach of modules, from the JSON that llvm-cov exports: figures of each, then every branch that none reaches.

usage: coverage.py EXPORT.json MODULE..   (a folder or the beginning of a file's path, as in base/file)
"""

import json
import os
import sys


def main():
    export, modules = sys.argv[1], sys.argv[2:]
    with open(export, encoding="utf-8") as file:
        files = json.load(file)["data"][0]["files"]
    ours = {of_the_project(entry["filename"]): entry for entry in files}
    print(f"{'module':24} {'lines':>15} {'branches':>15}")
    for module in modules:
        inside = [entry for path, entry in ours.items() if belongs(path, module)]
        print(f"{module:24} {share(inside, 'lines')} {share(inside, 'branches')}")
    for module in modules:
        for path, entry in sorted(ours.items()):
            if belongs(path, module):
                list_unreached(path, entry)


def of_the_project(path):
    """A file's path from the project's root. What is compiled in batches is named as if it stood in the build folder."""
    path = os.path.relpath(os.path.normpath(path))
    return path.removeprefix("build/coverage/")


def belongs(path, module):
    """Whether a file is of a module: in its folder, or the file itself with any extension."""
    return path.startswith(module + "/") or os.path.splitext(path)[0] == module


def share(entries, what):
    count = sum(entry["summary"][what]["count"] for entry in entries)
    covered = sum(entry["summary"][what]["covered"] for entry in entries)
    return f"{covered:>6}/{count:<6} {100 * covered / max(count, 1):5.1f}%".rjust(15)


def list_unreached(path, entry):
    """The branches that go one way only. Those of a template or inline function count together: each instance is listed once."""
    with open(path, encoding="utf-8") as file:
        text = file.read().split("\n")
    ways = {}
    for line, column, end_line, end_column, taken, not_taken, *_ in entry["branches"]:
        before = ways.get((line, column, end_line, end_column), (0, 0))
        ways[line, column, end_line, end_column] = (before[0] + taken, before[1] + not_taken)
    for (line, column, end_line, end_column), (taken, not_taken) in sorted(ways.items()):
        if taken and not_taken:
            continue
        condition = text[line - 1][column - 1 : end_column - 1 if end_line == line else None].strip()
        never = "never evaluated" if not taken and not not_taken else "never true" if not taken else "never false"
        print(f"{path}:{line}: {never}: {condition}")


main()
