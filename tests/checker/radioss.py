"""Radioss starter decks, after the OpenRadioss/Altair Radioss Reference Guide (starter input format; /NODE, /SHELL, /SH3N, /BRICK,
/BEAM, /TRUSS, /SPRING, /PART, /GRNOD, /GRSHEL, //SUBMODEL, /TRANSFORM, #include)."""
import os
import re

from deck_text import Affine, Deck, DeckError, Element, Node, SetPair, integer, real

NODES_OF = {"SHELL": 4, "SH3N": 3, "BRICK": 8, "TETRA4": 4, "TETRA10": 10, "BEAM": 3, "TRUSS": 2, "SPRING": 3, "PENTA6": 6, "QUAD": 4,
            "TRIA": 3, "BRIC20": 20, "SHEL16": 16, "SPHCEL": 1, "SHELL4N": 4}
# Cards that use a group of four-node shells and one of three-node shells: {word: (card from 1, the title's, {kind: field from 0})}.
PAIRS = {"SECT": (4, {"shell": 2, "sh3n": 6}), "ACTIV": (2, {"shell": 3, "sh3n": 7})}
GROUPS = {"GRNOD/NODE": "node", "GRNOD/NODENS": "node", "GRSHEL/SHEL": "shell", "GRSH3N/SH3N": "sh3n", "GRBRIC/BRIC": "brick"}
COORDINATES = ((10, 30), (30, 50), (50, 70))


class Reader:
    def __init__(self, path):
        self.deck = Deck(path)
        self.stack, self.block, self.card = [], None, 0
        self.submodel = 0
        self.placed = []  # /TRANSFORM that the checker doesn't follow

    def read_file(self, path):
        real_path = os.path.realpath(path)
        if real_path in self.stack or len(self.stack) > 100:
            self.deck.circular.append(path)
            return
        file = self.deck.add_file(path)
        if file is None:
            raise DeckError(f"{path}: can't be read")
        self.stack.append(real_path)
        for number, line in enumerate(self.deck.files[file].lines):
            if line.startswith("#"):
                if line.startswith("#include"):
                    self.include(line[8:].strip().strip("'\""), file)
                elif line.rstrip() == "#enddata":
                    break
                continue
            if line.startswith("/"):
                if self.keyword(line.rstrip(), number):
                    break
                continue
            if self.block and (line.strip() or self.block[0] in PAIRS):  # a section's file name may be blank
                self.data(file, number, line)
        self.stack.pop()

    def include(self, name, file):
        for folder in (os.path.dirname(self.deck.files[file].path), self.deck.folder):
            path = os.path.normpath(os.path.join(folder, name))
            if os.path.isfile(path):
                self.read_file(path)
                return
        self.deck.missing.append(name)

    def keyword(self, line, number):
        """Starts a block; true at the end of the file's data."""
        words = [w.strip().upper() for w in line.split("/")]
        if line.startswith("//"):
            self.block = None
            if words[2:3] == ["SUBMODEL"]:
                self.submodel = integer(words[3])
            elif words[2:3] == ["ENDSUB"]:
                self.submodel = 0
            return False
        self.block, self.card = words[1:], 0
        if words[1] == "TRANSFORM":
            self.placed.append(number)
        if words[1] == "PART" and len(words) > 2 and words[2].isdigit():
            self.deck.parts.add(int(words[2]))
        return words[1] == "END"

    def data(self, file, number, line):
        self.card += 1
        word = self.block[0]
        if word == "NODE":
            id = integer(line[:10])
            p = tuple(real(line[a:b].rstrip("\r")) for a, b in COORDINATES)
            self.deck.add_node(Node(id, p, None, file, (number,), COORDINATES))
        elif word in NODES_OF:
            self.element(file, number, line, word)
        elif len(self.block) > 2 and "/".join(self.block[:2]) in GROUPS:
            entry = self.deck.set_named(GROUPS["/".join(self.block[:2])], integer(self.block[2]), file)
            if self.card == 1:
                entry.title = number
                return
            entry.lines.append(number)
            for i in range(0, 100, 10):
                field = line[i:i + 10].strip()
                if field:
                    entry.members.add(integer(field))

        elif word in PAIRS and self.card == PAIRS[word][0]:
            places = {kind: (10 * field, 10 * field + 10) for kind, field in PAIRS[word][1].items()}
            sets = {kind: (integer(line[a:b]) if line[a:b].strip() else 0, (a, b)) for kind, (a, b) in places.items()}
            self.deck.pairs.append(SetPair("/".join(self.block), file, number, sets))

    def element(self, file, number, line, word):
        part = integer(self.block[1]) if len(self.block) > 1 else 0
        count = NODES_OF[word]
        values = [integer(line[i:i + 10].rstrip("\r")) if line[i:i + 10].strip() else 0 for i in range(0, 10 * (count + 1), 10)]
        nodes = tuple(values[1:])
        if word in ("BEAM", "SPRING"):
            nodes = nodes[:2]
        if word in ("BRIC20", "SHEL16", "TETRA10") and self.card % 3 != 1:
            return
        self.deck.count(word)
        self.deck.elements.append(Element(word.lower(), word, values[0], part, nodes, file, (number,)))


def read(path):
    reader = Reader(path)
    reader.read_file(path)
    return reader.deck
