"""Nastran bulk data, after the MSC/NX Nastran Quick Reference Guide (sections The Bulk Data Section: format, continuation, replication;
GRID, GRDSET, CORDij, INCLUDE and the element entries)."""
import os
import re

from deck_text import Affine, Curved, Deck, DeckError, Element, Node, axes_system, integer, real

# Fields of an element entry that hold grid points, counted from 1 = the name; a trailing None: up to the end.
SHELLS = {"CQUAD4": 4, "CQUADR": 4, "CSHEAR": 4, "CQUAD1": 4, "CTRIA3": 3, "CTRIAR": 3, "CQUAD8": 8, "CQUAD": 9, "CTRIA6": 6}
SOLIDS = {"CHEXA": 20, "CPENTA": 15, "CTETRA": 10, "CPYRAM": 13}
LINES = {"CBAR", "CBEAM", "CROD", "CTUBE", "CBUSH", "CBEND", "CVISC", "CGAP", "CBUSH1D", "CBEAM3"}
COUNTED = re.compile(r"^(C[A-Z].*|RBE[123]|RBAR|RROD|PLOTEL\d?|CONROD|CONM[12])$")
NOT_ELEMENTS = {"CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S", "CORD3G", "CEND", "CONVM", "CNGRNT"}
# How many properties an entry defines: each takes the same number of fields.
PROPERTIES = dict.fromkeys("PSHELL PCOMP PCOMPG PQUAD1 PSOLID PLSOLID PCOMPS PLPLANE PSHEAR PBAR PBARL PBEAM PBEAML PBCOMP PBEAM3 PROD PTUBE "
                           "PBUSH PBUSH1D PGAP PBEND PVISC PFAST PWELD PRAC2D PRAC3D".split(), 1)
PROPERTIES.update(PELAS=2, PDAMP=4, PMASS=4)


class Entry:
    """One bulk data entry: its fields from the name on (continuations appended), where they stand."""
    __slots__ = ("name", "fields", "file", "lines", "style")

    def __init__(self, name, fields, file, lines, style):
        self.name, self.fields, self.file, self.lines, self.style = name, fields, file, lines, style

    def text(self, i):
        return self.fields[i] if i < len(self.fields) else ""


def tabs(line):
    return line.expandtabs(8) if "\t" in line else line


def cut(line):
    """The ten fields of a line, without its comment; and its style."""
    line = tabs(line.rstrip("\r"))
    if "$" in line:
        line = line[:line.index("$")]
    first = line.split(",", 1)[0] if "," in line[:10] or "," in line else line[:8]
    if "," in line:
        fields = [f for part in line.split(",") for f in (part.split() or [""])]  # blanks separate as commas do
        big = fields[0].endswith("*")
        data = fields[1:5 if big else 9]
        data += [""] * ((4 if big else 8) - len(data))
        return first.strip(), data, "free*" if big else "free"
    line = line[:80].ljust(80)
    name = line[:8].strip()
    if "*" in name:
        return name, [line[i:i + 16].strip() for i in range(8, 72, 16)], "large"
    return name, [line[i:i + 8].strip() for i in range(8, 72, 8)], "small"


class Reader:
    def __init__(self, path):
        self.deck = Deck(path)
        self.entries, self.stack, self.ended = [], [], False
        self.bulk = False
        self.scalar = []  # (first, last) of SPOINT

    def read_file(self, path):
        real_path = os.path.realpath(path)
        if real_path in self.stack or len(self.stack) > 100:
            self.deck.circular.append(path)
            return
        file = self.deck.add_file(path)
        if file is None:
            raise DeckError(f"{path}: can't be read")
        self.stack.append(real_path)
        lines = self.deck.files[file].lines
        if len(self.stack) == 1:  # a deck without executive and case control begins with bulk data
            self.bulk = not any(re.match(r"\s*BEGIN\b", l, re.I) for l in lines[:200000])
        number = 0
        while number < len(lines) and not self.ended:
            number = self.read_line(file, lines, number)
        self.stack.pop()

    def read_line(self, file, lines, number):
        line = lines[number]
        stripped = line.lstrip().upper()
        if stripped.startswith("INCLUDE") and not stripped.startswith("INCLUDES"):
            return self.include(file, lines, number)
        if not self.bulk:
            self.bulk = bool(re.match(r"\s*BEGIN\b", line, re.I))
            return self.case_set(file, lines, number) or number + 1
        if not stripped.strip() or stripped[0] == "$":
            return number + 1
        if stripped.startswith("ENDDATA"):
            self.ended = True
            return number + 1
        name, data, style = cut(line)
        if name.startswith("+") or name.startswith("*") and "(" not in name or (not name and data):
            if self.entries and (not name or name[0] in "+*"):
                self.entries[-1].fields += data
                self.entries[-1].lines.append((number, style))
            return number + 1
        word = name.rstrip("*").upper()
        self.entries.append(Entry(word, [word] + data, file, [(number, style)], style))
        if name.startswith("=") or name.startswith("*(") or any(f.startswith(("=", "*(")) for f in data):
            self.replicate()
        return number + 1

    def case_set(self, file, lines, number):
        """SET n = 1, 5 THRU 9, ... of the case control: of nodes or elements, which its users decide. Continues in the next line after a comma."""
        found = re.match(r"\s*SET\s+(\d+)\s*=(.*)", lines[number], re.I)
        if not found:
            return None
        entry, text = self.deck.set_named("case", int(found.group(1)), file), found.group(2)
        entry.lines.append(number)
        while text.split("$")[0].rstrip().endswith(",") and number + 1 < len(lines):
            number += 1
            entry.lines.append(number)
            text = text.split("$")[0].rstrip() + lines[number]
        for item in text.split("$")[0].split(","):
            span = re.match(r"\s*(\d+)\s*(?:THRU\s*(\d+))?", item, re.I)
            if span and span.group(2):
                entry.ranges.append((int(span.group(1)), int(span.group(2))))
            elif span:
                entry.members.add(int(span.group(1)))
        return number + 1

    def replicate(self):
        """= repeats a field of the entry before, *(x) adds to it, =(n) or =n repeats the entry before n times more."""
        entry = self.entries.pop()
        before = self.entries[-1] if self.entries else None
        if before is None:
            raise DeckError("a replication without an entry before it")
        times = re.match(r"^=\(?(\d+)\)?$", entry.fields[0])
        step = getattr(self, "step", None)
        if times and not any(entry.fields[1:]) and step:
            for _ in range(int(times.group(1))):
                self.entries.append(Entry(before.name, self.next_fields(self.entries[-1].fields, step), entry.file, entry.lines, "replicated"))
            return
        self.step = entry.fields
        self.entries.append(Entry(before.name, self.next_fields(before.fields, entry.fields), entry.file, entry.lines, "replicated"))

    def next_fields(self, before, step):
        out, rest = [], False
        for i, old in enumerate(before):
            new = step[i] if i < len(step) else ""
            rest = rest or new == "=="
            add = re.match(r"^\*\(?([^()]+)\)?$", new)
            if rest or new == "=" or i == 0:
                out.append(old)
            elif add:
                whole = re.match(r"^[+-]?\d+$", add.group(1)) and re.match(r"^[+-]?\d+$", old)
                out.append(str(int(old) + int(add.group(1))) if whole else repr(real(old) + real(add.group(1))))
            else:
                out.append(new)
        return out

    def include(self, file, lines, number):
        """INCLUDE 'name': the name may span lines until its closing quote."""
        text = tabs(lines[number].rstrip("\r")).strip()[7:].strip()
        number += 1
        if text[:1] in "'\"" and text:
            quote = text[0]
            while quote not in text[1:] and number < len(lines):
                text += lines[number].strip()
                number += 1
            text = text[1:].split(quote)[0]
        else:
            text = text.split("$")[0].strip()
        name = text.strip()
        for folder in (os.path.dirname(self.deck.files[file].path), self.deck.folder):
            path = os.path.normpath(os.path.join(folder, name))
            if os.path.isfile(path):
                bulk = self.bulk
                self.read_file(path)
                self.bulk = self.bulk or bulk
                return number
        self.deck.missing.append(name)
        return number

    # Meaning ---------------------------------------------------------------------------------------------------------------------

    def understand(self):
        systems, grids, default = {}, [], 0
        for e in self.entries:
            if e.name == "GRDSET":
                default = integer(e.text(2))
        for e in self.entries:
            if e.name == "GRID":
                grids.append((integer(e.text(1)), e, integer(e.text(2)) or default))
            elif e.name.startswith("CORD"):
                systems_of(e, systems)
            elif e.name in PROPERTIES:
                step = 8 // PROPERTIES[e.name]
                self.deck.parts |= {integer(e.text(1 + step * i)) for i in range(PROPERTIES[e.name]) if e.text(1 + step * i)}
            elif e.name == "SPOINT":
                if e.text(2).upper() == "THRU":
                    self.scalar.append((integer(e.text(1)), integer(e.text(3))))
                else:
                    self.scalar += [(integer(f), integer(f)) for f in e.fields[1:] if f]
            elif e.name == "SPC1":
                self.constraint(e)
            elif COUNTED.match(e.name) and e.name not in NOT_ELEMENTS:
                self.element(e)
        self.place(grids, systems)
        for e in self.deck.elements:  # scalar points are no grid points
            if e.cls == "other":
                e.nodes = tuple(n for n in e.nodes if not any(a <= n <= b for a, b in self.scalar))

    def constraint(self, e):
        """SPC1, SID, C, then grid points or G1 THRU G2."""
        entry = self.deck.set_named("node", f"SPC1 {e.text(1)} {e.text(2)}", e.file)
        entry.lines += [n for n, _ in e.lines]
        if e.text(4).upper() == "THRU":
            entry.ranges.append((integer(e.text(3)), integer(e.text(5))))
        else:
            entry.members.update(integer(f) for f in e.fields[3:] if f.isdigit())

    def place(self, grids, systems):
        """Grid points in systems that are defined by grid points (CORD1x) are placed once those are known."""
        local = {id: (tuple(real(e.text(i)) for i in (3, 4, 5)), cp) for id, e, cp in grids}
        frames, busy = {0: None}, set()

        def point(id):
            p, cp = local[id]
            f = frame(cp)
            return f.to_basic(p) if f else p

        def frame(cid):
            if cid in frames:
                return frames[cid]
            if cid in busy or cid not in systems:
                raise DeckError(f"coordinate system {cid} is circular or not there")
            busy.add(cid)
            kind, definition = systems[cid]
            if len(definition) == 3:
                a, b, c = (point(g) for g in definition)
            else:
                f = frame(definition[0])
                a, b, c = (f.to_basic(p) if f else p for p in definition[1:])
            axes = axes_system(a, tuple(b[i] - a[i] for i in range(3)), tuple(c[i] - a[i] for i in range(3)))
            frames[cid] = axes if kind == "R" else Curved({"C": "cylindrical", "S": "spherical"}[kind], axes)
            return frames[cid]

        for id, e, cp in grids:
            try:
                f = frame(cp)
            except (DeckError, KeyError, ValueError):
                self.deck.unread.append((self.deck.files[e.file].relative, e.lines[0][0] + 1, f"system {cp}"))
                f = None
            self.deck.add_node(Node(id, local[id][0] if local[id] else None, f, e.file, tuple(n for n, _ in e.lines), e.style))

    def element(self, e):
        self.deck.count(e.name)
        id = integer(e.text(1)) if e.text(1).lstrip("-").isdigit() else 0
        nodes, part = (), None
        try:
            if e.name in SHELLS:
                part, nodes = integer(e.text(2) or e.text(1)), tuple(integer(e.text(i)) for i in range(3, 3 + min(SHELLS[e.name], 9)))
            elif e.name in SOLIDS:
                part, nodes = integer(e.text(2) or e.text(1)), tuple(integer(e.text(i)) for i in range(3, 3 + SOLIDS[e.name]))
            elif e.name in LINES:
                part, nodes = integer(e.text(2) or e.text(1)), tuple(integer(e.text(i)) for i in (3, 4))
            elif e.name == "CONROD":
                nodes = (integer(e.text(2)), integer(e.text(3)))
            elif e.name in ("CELAS1", "CDAMP1", "CMASS1"):
                part, nodes = integer(e.text(2) or e.text(1)), (integer(e.text(3)), integer(e.text(5)))
            elif e.name in ("CELAS2", "CDAMP2", "CMASS2"):
                nodes = (integer(e.text(3)), integer(e.text(5)))
            elif e.name == "CONM2":
                nodes = (integer(e.text(2)),)
        except ValueError:
            self.deck.unread.append((self.deck.files[e.file].relative, e.lines[0][0] + 1, e.name))
        cls = "shell" if e.name in SHELLS else "solid" if e.name in SOLIDS else "other"
        self.deck.elements.append(Element(cls, e.name, id, part, nodes, e.file, tuple(n for n, _ in e.lines)))


def systems_of(e, systems):
    kind = e.name[5:6]
    if e.name.startswith("CORD1"):
        for at in (1, 5):
            if e.text(at):
                systems[integer(e.text(at))] = kind, tuple(integer(e.text(at + k)) for k in (1, 2, 3))
    elif e.name.startswith("CORD2"):
        v = [real(e.text(i)) for i in range(3, 12)]
        systems[integer(e.text(1))] = kind, (integer(e.text(2)), tuple(v[:3]), tuple(v[3:6]), tuple(v[6:9]))


def coordinate_fields(deck, node):
    """[(line, begin, end)] of the three coordinates in the lines of a grid point's card."""
    lines, out = deck.files[node.file].lines, []
    wanted, passed = (2, 3, 4), 0  # data fields of the entry, from 0
    for number in node.lines:
        line = lines[number]
        _, data, style = cut(line)
        for i in wanted:
            k = i - passed
            if 0 <= k < len(data):
                out.append((number, *field_bounds(line, k, style)))
        passed += len(data)
    return out


def field_bounds(line, k, style):
    if style.startswith("free"):
        at = 0
        for _ in range(k + 1):
            at = line.index(",", at) + 1 if "," in line[at:] else len(line)
        end = line.find(",", at)
        return at, end if end >= 0 else len(line.split("$")[0].rstrip("\r"))
    if "\t" in line:
        return 8, len(line)  # columns move with the tabs: the whole card is the coordinates' room
    width = 16 if style == "large" else 8
    return 8 + k * width, 8 + (k + 1) * width


def read(path):
    reader = Reader(path)
    reader.read_file(path)
    reader.understand()
    return reader.deck
