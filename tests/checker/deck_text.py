"""What the formats share: the entities of a deck with the lines they stand on, numbers as solvers write them, coordinate systems.

This folder is a second opinion on what the program reads and writes. It follows the formats' manuals and shares nothing with the
program; keep it so.
"""
import math
import os
import re


class DeckError(Exception):
    """The deck can't be read, by the checker's own rules."""


class File:
    def __init__(self, path, relative, data):
        self.path, self.relative, self.data = path, relative, data
        self.lines = data.decode("latin-1").split("\n")  # without \n, with \r where there is one


class Node:
    """local: as the card has it, in its frame; fields: [(line, begin, end)] of the three coordinates in the file's lines."""
    __slots__ = ("id", "local", "frame", "file", "lines", "layout")

    def __init__(self, id, local, frame, file, lines, layout):
        self.id, self.local, self.frame, self.file, self.lines, self.layout = id, local, frame, file, lines, layout

    def basic(self):
        return self.frame.to_basic(self.local) if self.frame else self.local


class Element:
    """cls: ids are unique within it. kind: the deck's own word. part: an int or a name; None where the card has none."""
    __slots__ = ("cls", "kind", "id", "part", "nodes", "file", "lines")

    def __init__(self, cls, kind, id, part, nodes, file, lines):
        self.cls, self.kind, self.id, self.part, self.nodes, self.file, self.lines = cls, kind, id, part, nodes, file, lines


class Set:
    """members: what the set lists; ranges: (first, last) of what it generates. Both may stand in one set. title: its line, where it has one of
    its own."""

    def __init__(self, kind, id, file):
        self.kind, self.id, self.file = kind, id, file
        self.members, self.ranges, self.lines, self.title = set(), [], [], None


class SetPair:
    """A card that uses a set of each kind: sets is {kind: (id, (begin, end) in its line)}, 0 for none."""

    def __init__(self, name, file, line, sets):
        self.name, self.file, self.line, self.sets = name, file, line, sets


class Deck:
    def __init__(self, path):
        self.path = os.path.abspath(path)
        self.folder = os.path.dirname(self.path)
        self.files, self.missing, self.circular = [], [], []
        self.nodes, self.elements = {}, []
        self.duplicate_nodes = 0
        self.parts, self.sets, self.words = set(), {}, {}
        self.pairs = []  # of sets that one card uses: SetPair
        self.unread = []  # (file, line) of cards that carry meaning for the mesh and that the checker doesn't understand

    def add_file(self, path):
        try:
            with open(path, "rb") as f:
                data = f.read()
        except OSError:
            return None
        self.files.append(File(path, os.path.relpath(path, self.folder), data))
        return len(self.files) - 1

    def add_node(self, node):
        if node.id in self.nodes:
            self.duplicate_nodes += 1
        self.nodes[node.id] = node

    def count(self, word):
        self.words[word] = self.words.get(word, 0) + 1

    def set_named(self, kind, id, file):
        return self.sets.setdefault((kind, id), Set(kind, id, file))

    def parts_with_elements(self):
        return {e.part for e in self.elements if e.part is not None}

    def undefined_nodes(self):
        return sum(1 for e in self.elements for n in e.nodes if n and n not in self.nodes)


EXPONENT = re.compile(r"^([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdDqQ]([+-]?\d+)|([+-]\d+))$")


def real(text):
    """A Fortran real: 1., .5, 1.5-3, 2D4. Blank is 0."""
    try:
        return float(text)
    except ValueError:
        text = text.strip()
        if not text:
            return 0.0
        m = EXPONENT.match(text)
        if not m:
            raise ValueError(f"'{text}' is no number")
        return float(m.group(1) + "e" + (m.group(2) or m.group(3)))


def integer(text):
    """An integer, also written as 12. or blank (0)."""
    try:
        return int(text)
    except ValueError:
        value = real(text)
        if value != int(value):
            raise ValueError(f"'{text}' is no integer")
        return int(value)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def plus(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def unit(a):
    length = math.sqrt(dot(a, a))
    if length == 0:
        raise ValueError("a direction of length 0")
    return (a[0] / length, a[1] / length, a[2] / length)


class Affine:
    """p -> rows . p + shift."""

    def __init__(self, rows=((1, 0, 0), (0, 1, 0), (0, 0, 1)), shift=(0, 0, 0)):
        self.rows, self.shift = rows, shift

    def to_basic(self, p):
        return plus(tuple(dot(r, p) for r in self.rows), self.shift)

    def then(self, after):
        columns = tuple(zip(*self.rows))
        return Affine(tuple(tuple(dot(r, c) for c in columns) for r in after.rows), after.to_basic(self.shift))

    def from_basic(self, p):
        a, b, c = self.rows
        det = dot(a, cross(b, c))
        q = minus(p, self.shift)
        columns = (cross(b, c), cross(c, a), cross(a, b))  # the inverse's columns, times det
        return tuple(sum(columns[j][i] * q[j] for j in range(3)) / det for i in range(3))


class Curved:
    """Cylindrical (r, theta in degrees, z) or spherical (r, theta from the axis, phi, in degrees) values on an affine system."""

    def __init__(self, kind, axes):
        self.kind, self.axes = kind, axes

    def to_basic(self, p):
        r, t = p[0], math.radians(p[1])
        if self.kind == "cylindrical":
            return self.axes.to_basic((r * math.cos(t), r * math.sin(t), p[2]))
        f = math.radians(p[2])
        return self.axes.to_basic((r * math.sin(t) * math.cos(f), r * math.sin(t) * math.sin(f), r * math.cos(t)))

    def from_basic(self, p):
        x, y, z = self.axes.from_basic(p)
        if self.kind == "cylindrical":
            return (math.hypot(x, y), math.degrees(math.atan2(y, x)), z)
        return (math.sqrt(x * x + y * y + z * z), math.degrees(math.atan2(math.hypot(x, y), z)), math.degrees(math.atan2(y, x)))


def axes_system(origin, z_direction, xz_direction):
    """The system with its third axis along one direction and its first in the half plane of the other."""
    k = unit(z_direction)
    j = unit(cross(k, xz_direction))
    i = cross(j, k)
    return Affine(tuple(zip(i, j, k)), origin)
