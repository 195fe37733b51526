#!/usr/bin/env python3
"""Counts what the core's operations cost, in instructions and memory, and compares with a table.

Status 0: nothing costs more than the table says; 1: something does; 77: it can't be counted here. docs/building.md says how to read it.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SIZES = (10_000, 40_000)  # shells
MAX_RATIO = 1.1  # of a figure to that of the table
# By order, the max growth between the two sizes.
ORDERS = {"constant": 1.25, "root": 2.2, "linear": 4.4, "n log n": 5.0, "quadratic": 17.0}
FIGURES = ("instructions a shell", "growth", "bytes a shell", "growth of bytes")
HEAD = """\
# What operations of the core cost: instructions and peak memory a shell at 10,000 shells, and the growth of both to 40,000 shells.
# `order` bounds the growth. Written by `./station cost --write`, which keeps the orders; docs/building.md says how to read it.
# Columns are two spaces apart: operation, order, instructions a shell, growth, bytes a shell, growth of bytes.
"""
SKIPPED = 77


class CostError(Exception):
    """A file or a run that can't be used; the text says why."""


@dataclass
class Row:
    order: str
    figures: tuple  # as FIGURES


def rounded(value):
    """Four significant digits, so that the table doesn't change for nothing."""
    return float(f"{value:.4g}")


def plain(value):
    return f"{value:.4g}" if value < 1000 else f"{value:.0f}"


def read_table(text, name="table.txt"):
    """Returns what the table was made with, and its rows by operation."""
    made_with, rows = None, {}
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        fields = re.split(r"\s{2,}", line.strip())
        where = f"{name}:{number}: "
        if made_with is None:
            if len(fields) != 2 or fields[0] != "made with":
                raise CostError(where + "the first line isn't what the table was made with")
            made_with = fields[1]
            continue
        if len(fields) != 2 + len(FIGURES):
            raise CostError(where + f"there are {len(fields)} columns instead of {2 + len(FIGURES)}; columns are two spaces apart")
        if fields[1] not in ORDERS:
            raise CostError(where + f"no order '{fields[1]}'; there are {', '.join(ORDERS)}")
        if fields[0] in rows:
            raise CostError(where + f"'{fields[0]}' stands twice")
        try:
            rows[fields[0]] = Row(fields[1], tuple(float(field) for field in fields[2:]))
        except ValueError as error:
            raise CostError(where + "a figure isn't a number") from error
    if made_with is None:
        raise CostError(f"{name}: it is empty")
    return made_with, rows


def content_of(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise CostError(f"{path} can't be read: {error}; ./station cost --write makes it anew") from error


def order_of(growth):
    return next((order for order, max_growth in ORDERS.items() if growth <= max_growth), "quadratic")


def write_table(made_with, measured, old):
    """The table's text. An order stays as it is: only a person changes it. A new row gets the smallest that its growth allows. A figure that
    is off by less than a hundredth stays too, so that a commit shows what has changed."""
    text = HEAD + f"\nmade with  {made_with}\n\n"
    for name, figures in measured.items():
        order = order_of(figures[1])
        if name in old:
            order = old[name].order
            figures = [was if abs(now - was) < 0.01 * was else now for was, now in zip(old[name].figures, figures)]
        text += f"{name:<28}  {order:<9}" + "".join(f"  {plain(figure):>9}" for figure in figures) + "\n"
    return text


def changed(name, what, was, now):
    percent = f" ({100 * (now / was - 1):+.1f} %)" if was > 0 else ""
    return f"{name}: {what}: was {plain(was)}, is {plain(now)}{percent}"


def compare(table, measured):
    """Returns what is dearer than the table says, and what is cheaper, as lines."""
    dearer, cheaper = [], []
    for name, figures in measured.items():
        if name not in table:
            dearer.append(f"{name}: it isn't in the table")
            continue
        row = table[name]
        for what, was, now in zip(FIGURES, row.figures, figures):
            if now > MAX_RATIO * was:
                dearer.append(changed(name, what, was, now))
            elif MAX_RATIO * now < was:
                cheaper.append(changed(name, what, was, now))
        if figures[1] > ORDERS[row.order]:
            dearer.append(f"{name}: growth is {plain(figures[1])}, and its order '{row.order}' allows {ORDERS[row.order]}")
    dearer += [f"{name}: it is in the table, but isn't measured" for name in table if name not in measured]
    return dearer, cheaper


def figures_of(counts, shells):
    """`counts`: by size, by operation, instructions and bytes. Returns the figures by operation."""
    small, large = counts
    if list(small) != list(large):
        raise CostError("the two sizes have different operations")
    figures = {}
    for name, (instructions, peak) in small.items():
        growth = [b / a if a > 0 else 1.0 for a, b in zip((instructions, peak), large[name])]
        figures[name] = tuple(rounded(f) for f in (instructions / shells, growth[0], peak / shells, growth[1]))
    return figures


def instructions_in(folder, size):
    """Reads Callgrind's dumps of a run: instructions by operation, in their order."""
    counts = {}
    number = 1
    while os.path.exists(path := os.path.join(folder, f"{size}.{number}")):
        with open(path, encoding="utf-8", errors="replace") as dump:
            head = dump.read(4096)
        name, total = (re.search(pattern, head, re.M) for pattern in (r"^desc: Trigger: Client Request: (.*)$", r"^summary: (\d+)"))
        if name and total:
            counts[name[1]] = int(total[1])
        number += 1
    return counts


def run(program, size, folder):
    """Returns by operation its instructions and its peak of bytes."""
    command = ["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={os.path.join(folder, str(size))}", program, str(size)]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, env={**os.environ, "LC_ALL": "C"})
    if done.returncode != 0:
        raise CostError(f"{' '.join(command)} ended with status {done.returncode}:\n{done.stderr[-2000:]}")
    counts = instructions_in(folder, size)
    peaks = dict(line.split("\t") for line in done.stdout.splitlines())
    if list(counts) != list(peaks):
        raise CostError(f"at {size} shells Callgrind counted {len(counts)} operations of {len(peaks)}: was the program built without <valgrind/callgrind.h>?")
    return {name: (counts[name], int(peak)) for name, peak in peaks.items()}


def reason_to_skip(program, made_with):
    """Why counts here can't be compared with the table; None if they can."""
    if shutil.which("valgrind") is None:
        return "valgrind is missing (Debian package valgrind)"
    with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as info:
        if " avx2" not in info.read():
            return "this processor has no AVX2, for which metrics have code of their own"
    here = made_here(program)
    if made_with is not None and here != made_with:
        return f"the table was made with {made_with}, and this is {here}"
    return None


def made_here(program):
    return subprocess.run([program, "--made-with"], capture_output=True, text=True, check=True).stdout.strip()


def print_beside(table, measured):
    print(f"{'':<28}  {'':<9}" + "".join(f"  {what:>22}" for what in FIGURES))
    for name, figures in measured.items():
        row = table.get(name)
        was = row.figures if row else (None,) * len(FIGURES)
        cells = "".join(f"  {plain(now) + ' (' + (plain(old) if old is not None else 'new') + ')':>22}" for now, old in zip(figures, was))
        print(f"{name:<28}  {row.order if row else order_of(figures[1]):<9}{cells}")


def main():
    parser = argparse.ArgumentParser(prog="station cost", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="tests/cost/main.cpp, built for release")
    parser.add_argument("--write", action="store_true", help="write what is measured into the table")
    parser.add_argument("--table", default=os.path.join(ROOT, "tests", "cost", "table.txt"), help="default: tests/cost/table.txt")
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "cost"), help="where Callgrind's dumps go (default: out/cost)")
    options = parser.parse_args()
    made_with, table = None, {}
    if not options.write or os.path.exists(options.table):
        made_with, table = read_table(content_of(options.table), os.path.relpath(options.table, ROOT))
    if reason := reason_to_skip(options.program, None if options.write else made_with):
        print(f"SKIPPED: cost.table counted nothing: {reason}")  # ./station test repeats such lines at its end
        return SKIPPED
    shutil.rmtree(options.out, ignore_errors=True)
    os.makedirs(options.out)
    measured = figures_of([run(options.program, size, options.out) for size in SIZES], SIZES[0])
    print("What is measured, and in brackets what the table has:")
    print_beside(table, measured)
    dearer, cheaper = compare(table, measured)
    if options.write:
        with open(options.table, "w", encoding="utf-8") as file:
            file.write(write_table(made_here(options.program), measured, table))
        print("Written. Say in the commit why figures have changed.")
        return 0
    for line in cheaper:
        print(f"cheaper  {line}")
    if cheaper:
        print("Run ./station cost --write, so that the table keeps what was gained.")
    for line in dearer:
        print(f"DEARER  {line}")
    if dearer:
        print("If this is meant, run ./station cost --write and say why in the commit; a growth beyond its order needs another order in\n"
              "tests/cost/table.txt, by hand. callgrind_annotate out/cost/40000.N names the functions; N counts the rows from 1.")
    return 1 if dearer else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except CostError as error:
        sys.exit(f"cost: {error}")
