"""Abaqus input, after the Abaqus Analysis User's Guide (Input syntax rules; *NODE, *ELEMENT, *NSET, *ELSET, *INCLUDE, sections)."""
import os

from deck_text import Deck, DeckError, Element, Node, integer, real

SECTIONS = {"SHELL SECTION", "SOLID SECTION", "BEAM SECTION", "MEMBRANE SECTION", "SHELL GENERAL SECTION", "BEAM GENERAL SECTION",
            "FLUID SECTION", "RIGID BODY"}
# Number of nodes of an element type whose data span lines.
LONG = {"C3D20": 20, "C3D20R": 20, "C3D27": 27, "C3D15": 15}


class Reader:
    def __init__(self, path):
        self.deck = Deck(path)
        self.stack, self.word, self.options, self.open = [], "", {}, None
        self.sections, self.plain_sets, self.element_sets = [], {}, {}

    def read_file(self, path):
        real_path = os.path.realpath(path)
        if real_path in self.stack or len(self.stack) > 100:
            self.deck.circular.append(path)
            return
        file = self.deck.add_file(path)
        if file is None:
            raise DeckError(f"{path}: can't be read")
        self.stack.append(real_path)
        lines, number = self.deck.files[file].lines, 0
        while number < len(lines):
            line = lines[number].rstrip("\r")
            number += 1
            if line.startswith("**") or not line.strip():
                continue
            if line.startswith("*"):
                while line.rstrip().endswith(",") and number < len(lines):  # a keyword line goes on after a comma
                    line += lines[number].rstrip("\r")
                    number += 1
                self.keyword(line, file)
            else:
                self.data(file, number - 1, line)
        self.stack.pop()

    def keyword(self, line, file):
        words = [w.strip() for w in line[1:].split(",")]
        self.word, self.open = " ".join(words[0].upper().split()), None
        self.options = {}
        for w in words[1:]:
            name, _, value = w.partition("=")
            self.options[" ".join(name.upper().split())] = value.strip().strip('"')
        if self.word == "INCLUDE":
            self.include(self.options.get("INPUT", ""), file)
        elif self.word in SECTIONS and "ELSET" in self.options:
            self.sections.append(self.options["ELSET"].upper())

    def include(self, name, file):
        for folder in (self.deck.folder, os.path.dirname(self.deck.files[file].path)):
            path = os.path.normpath(os.path.join(folder, name))
            if name and os.path.isfile(path):
                self.read_file(path)
                self.word = ""
                return
        self.deck.missing.append(name)

    def data(self, file, number, line):
        fields = [f.strip() for f in line.split(",")]
        if self.word == "NODE":
            values = fields + [""] * 4
            self.deck.add_node(Node(integer(values[0]), tuple(real(v) for v in values[1:4]), None, file, (number,), "comma"))
        elif self.word == "ELEMENT":
            self.element(file, number, fields)
        elif self.word in ("NSET", "ELSET"):
            self.members(file, number, fields)

    def element(self, file, number, fields):
        values = [integer(f) for f in fields if f]
        kind = self.options.get("TYPE", "").upper()
        if self.open:
            self.open.nodes += tuple(values)
            self.open.lines += (number,)
        else:
            part = self.options.get("ELSET", "").upper() or None
            self.open = Element("element", kind, values[0], part, tuple(values[1:]), file, (number,))
            self.deck.count(kind)
            self.deck.elements.append(self.open)
            if part:
                self.element_sets.setdefault(part, set()).add(values[0])
        if len(self.open.nodes) >= LONG.get(kind, 0):
            self.open = None

    def members(self, file, number, fields):
        name = self.options.get(self.word, "").upper()
        entry = self.deck.set_named("node" if self.word == "NSET" else "element", name, file)
        entry.lines.append(number)
        values = [f for f in fields if f]
        if "GENERATE" in self.options:
            entry.ranges.append((integer(values[0]), integer(values[1])))
            return
        for v in values:
            if v.lstrip("+-").isdigit():
                entry.members.add(int(v))
            else:
                other = self.deck.sets.get((entry.kind, v.upper()))
                entry.members |= other.members if other else self.element_sets.get(v.upper(), set())
                entry.ranges += other.ranges if other else []


def read(path):
    reader = Reader(path)
    reader.read_file(path)
    deck = reader.deck
    deck.parts = set(reader.sections)
    belongs = {}
    for name in reader.sections:
        entry = deck.sets.get(("element", name))
        ids = set(reader.element_sets.get(name, ())) | (entry.members if entry else set())
        for id in ids:
            belongs[id] = name
        for first, last in entry.ranges if entry else ():
            for e in deck.elements:
                if first <= e.id <= last:
                    belongs[e.id] = name
    for e in deck.elements:
        e.part = belongs.get(e.id, e.part)
    return deck
