"""What the tests of the Python package share: the package, the program, a deck written here, folders as bytes."""
import json
import os
import subprocess
import sys

if len(sys.argv) < 3:
    sys.exit(f"usage: {sys.argv[0]} FOLDER_OF_THE_PACKAGE PRISMESH [unittest's arguments]")
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.abspath(sys.argv[1]))
PROGRAM = os.path.abspath(sys.argv[2])
del sys.argv[1:3]


def program(*arguments):
    """Exit status, standard output, standard error."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, errors="surrogateescape")
    return done.returncode, done.stdout, done.stderr


def program_json(*arguments):
    """The objects that the program prints, a list."""
    status, out, err = program(*arguments, "--json")
    if status != 0:
        raise AssertionError(f"{arguments}: {err}")
    return [json.loads(line) for line in out.splitlines()]


def place(i, j):
    """Where node (i, j) of the sheet is: waves, so that there is something to relax."""
    return (5.0 * i, 5.0 * j, round(0.7 * ((i * 7 + j * 5) % 4), 3))


def write_sheet(path, columns, rows):
    """A sheet of quads of part 1, and a beam of part 2 along its first edge; node (i, j) has the id 1 + i + j * (columns + 1)."""
    node = lambda i, j: 1 + i + j * (columns + 1)  # noqa: E731
    lines = ["*KEYWORD", "*PART", "sheet", "%10d%10d%10d" % (1, 1, 1), "*PART", "bar", "%10d%10d%10d" % (2, 2, 1), "*SECTION_SHELL",
             "%10d%10d" % (1, 2), "%10s%10s%10s%10s" % (1.5, 1.5, 1.5, 1.5), "*NODE"]
    for j in range(rows + 1):
        for i in range(columns + 1):
            lines.append("%8d%16.3f%16.3f%16.3f" % (node(i, j), *place(i, j)))
    lines.append("*ELEMENT_SHELL")
    for j in range(rows):
        for i in range(columns):
            lines.append("%8d" * 6 % (1 + i + j * columns, 1, node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)))
    lines += ["*ELEMENT_BEAM", "%8d" * 5 % (900001, 2, node(0, 0), node(1, 0), node(0, 1)), "*END", ""]
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join(lines))


def files_of(folder):
    """{relative path: bytes} of all files below a folder."""
    found = {}
    for at, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(at, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def without_time(reports):
    return [{key: value for key, value in report.items() if key != "ms"} for report in reports]
