"""LS-DYNA keyword decks, after the LS-DYNA Keyword User's Manual, volume I (sections GENERAL CARD FORMAT, *DEFINE_TRANSFORMATION,
*ELEMENT, *INCLUDE, *NODE, *PARAMETER, *PART, *SET)."""
import ast
import math
import os
import re

from deck_text import Affine, Deck, DeckError, Element, Node, cross, dot, integer, minus, plus, real, unit

# Cards after the first of an element, per option: THICKNESS and BETA share one.
SOLIDS = {8: "SOLID_HEX", 6: "SOLID_PENTA", 5: "SOLID_PYRAMID", 4: "SOLID_TET", 10: "SOLID_TET10", 20: "SOLID_HEX20"}
FUNCTIONS = {name: getattr(math, name) for name in
             "sin cos tan asin acos atan atan2 sinh cosh tanh exp sqrt log10 floor ceil".split()}
FUNCTIONS.update(abs=abs, min=min, max=max, ln=math.log, log=math.log, int=lambda x: float(int(x)), nint=lambda x: float(round(x)),
                 aint=lambda x: float(int(x)), anint=lambda x: float(round(x)), mod=math.fmod, sign=lambda a, b: math.copysign(a, b))


def evaluate(text, parameters):
    """Arithmetic over parameters; anything but numbers, names, operators and known functions is an error."""
    def value(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return node.value
        if isinstance(node, ast.Name):
            return math.pi if node.id == "pi" and "pi" not in parameters else parameters[node.id]
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            return -value(node.operand) if isinstance(node.op, ast.USub) else value(node.operand)
        if isinstance(node, ast.BinOp):
            a, b = value(node.left), value(node.right)
            if isinstance(node.op, ast.Add):
                return a + b
            if isinstance(node.op, ast.Sub):
                return a - b
            if isinstance(node.op, ast.Mult):
                return a * b
            if isinstance(node.op, ast.Pow):
                return float(a) ** b
            if isinstance(node.op, ast.Div):  # of two integers: as Fortran divides them
                return int(a / b) if isinstance(a, int) and isinstance(b, int) else a / b
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS:
            return FUNCTIONS[node.func.id](*map(value, node.args))
        raise ValueError("an expression the checker doesn't know")
    clean = re.sub(r"&", "", text.lower()).replace("^", "**").strip()
    return value(ast.parse(clean, mode="eval").body)


class Scope:
    """Parameters as one file sees them: its own local ones, those of the files that include it, the global ones."""

    def __init__(self, outer, shared):
        self.local, self.outer, self.shared = {}, outer, shared

    def __contains__(self, name):
        return name in self.local or (name in self.outer if self.outer else name in self.shared)

    def __getitem__(self, name):
        if name in self.local:
            return self.local[name]
        return self.outer[name] if self.outer else self.shared[name]


class Block:
    """Data lines of one keyword: numbers of its lines and how wide its fields are."""

    def __init__(self, word, suffix):
        self.word, self.suffix, self.rows = word, suffix, []


class Offsets:
    def __init__(self, node=0, element=0, part=0, set_=0):
        self.node, self.element, self.part, self.set = node, element, part, set_

    def plus(self, o):
        return Offsets(self.node + o.node, self.element + o.element, self.part + o.part, self.set + o.set)


class Reader:
    def __init__(self, path):
        self.deck = Deck(path)
        self.paths, self.transformations, self.globals, self.long, self.i10 = [], {}, {}, False, False
        self.depth = []

    # Lines -----------------------------------------------------------------------------------------------------------------------

    def cut(self, text, widths, suffix, scope):
        """A card's fields, parameters replaced by their text."""
        text = text.rstrip("\r")
        if "," in text:
            out = [f.strip() for f in text.split(",")]
            out += [""] * (len(widths) - len(out))
        else:
            if suffix == "+":
                widths = [20] * len(widths)
            elif suffix == "%":
                widths = [10 if w == 8 else w for w in widths]
            if "\t" in text:
                text = text.expandtabs(8)
            out, at = [], 0
            for w in widths:
                out.append(text[at:at + w].strip())
                at += w
        if "&" in text:
            out = [self.replaced(f, scope) for f in out]
        return out

    def replaced(self, field, scope):
        if "&" not in field:
            return field
        sign, name = ("-", field[1:]) if field.startswith("-") else ("", field)
        if name.startswith("&") and name[1:].lower() in scope:
            return sign + repr(scope[name[1:].lower()])
        raise ValueError(f"'{field}' isn't defined")

    def blocks(self, file):
        """The keyword blocks of a file; comments, encrypted text and what follows *END left out."""
        block, locked = None, False
        for number, line in enumerate(self.deck.files[file].lines):
            if locked:
                locked = not line.startswith("-----END PGP")
            elif line.startswith("-----BEGIN PGP"):
                locked = True
            elif line.startswith("*"):
                words = line.strip().upper().split(",")[0].split()
                word = words[0]
                suffix = "+" if self.long else "%" if self.i10 else ""
                if len(word) > 1 and word[-1] in "+-%":
                    suffix, word = {"+": "+", "-": "", "%": "%"}[word[-1]], word[:-1]
                elif len(words) > 1 and words[1] in ("+", "-", "%"):
                    suffix = {"+": "+", "-": "", "%": "%"}[words[1]]
                if word == "*KEYWORD":
                    joined = line.upper().replace(" ", "")
                    self.long = "LONG=Y" in joined
                    self.i10 = "I10=Y" in joined
                if block:
                    yield block
                block = Block(word, suffix)
                if word == "*END":
                    return
            elif line.startswith("$") or block is None:
                continue
            elif line.strip() or block.word.startswith(("*PART", "*INCLUDE_TRANSFORM")) or "TITLE" in block.word:
                block.rows.append((number, line))
        if block:
            yield block

    # Files -----------------------------------------------------------------------------------------------------------------------

    def read_file(self, path, scope, offsets, frame):
        real_path = os.path.realpath(path)
        if real_path in self.depth or len(self.depth) > 100:
            self.deck.circular.append(path)
            return
        file = self.deck.add_file(path)
        if file is None:
            raise DeckError(f"{path}: can't be read")
        self.depth.append(real_path)
        for block in self.blocks(file):
            self.read_block(file, block, scope, offsets, frame)
        self.depth.pop()

    def find(self, name, file):
        here = os.path.dirname(self.deck.files[file].path)
        for folder in [self.deck.folder, here, *self.paths]:
            path = os.path.normpath(os.path.join(folder, name))
            if os.path.isfile(path):
                return path
        return None

    def include(self, name, file, scope, offsets, frame):
        path = self.find(name, file)
        if path is None:
            self.deck.missing.append(name)
            return
        mode = self.long, self.i10
        self.read_file(path, Scope(scope, self.globals), offsets, frame)
        self.long, self.i10 = mode

    def names(self, rows):
        """File names may continue in the next line after ' +'."""
        name = ""
        for _, line in rows:
            line = line.strip()
            if line.endswith(" +"):
                name += line[:-2].strip()
                continue
            yield name + line
            name = ""

    # Keywords --------------------------------------------------------------------------------------------------------------------

    def read_block(self, file, block, scope, offsets, frame):
        word = block.word
        if word == "*INCLUDE":
            for name in self.names(block.rows):
                self.include(name, file, scope, offsets, frame)
        elif word in ("*INCLUDE_PATH", "*INCLUDE_PATH_RELATIVE"):
            base = self.deck.folder if word.endswith("RELATIVE") else os.getcwd()
            self.paths += [os.path.normpath(os.path.join(base, name)) for name in self.names(block.rows)]
        elif word == "*INCLUDE_TRANSFORM":
            self.include_transform(file, block, scope, offsets, frame)
        elif word.startswith("*PARAMETER"):
            self.parameters(block, scope)
        elif word == "*DEFINE_TRANSFORMATION":
            self.transformation(block, scope, offsets)
        elif word == "*NODE":
            self.nodes(file, block, scope, offsets, frame)
        elif word.startswith("*ELEMENT_"):
            self.elements(file, block, scope, offsets)
        elif word.startswith("*PART") and word.split("_")[0] == "*PART" and word not in (
                "*PART_MOVE", "*PART_MODES", "*PART_SENSOR", "*PART_ADAPTIVE_FAILURE", "*PART_ANNEAL", "*PART_DUPLICATE", "*PART_STACKED_ELEMENTS"):
            self.parts(block, scope, offsets)
        elif word.startswith("*SET_"):
            self.sets(file, block, scope, offsets)
        elif word.startswith("*CONSTRAINED_NODAL_RIGID_BODY"):
            self.deck.count("CNRB")
        elif word.startswith("*CONSTRAINED_GENERALIZED_WELD"):
            self.deck.count("C_GENWELD_blocks")

    def include_transform(self, file, block, scope, offsets, frame):
        rows = [line for _, line in block.rows]
        numbers = self.cut(rows[1] if len(rows) > 1 else "", [10] * 7, "", scope)
        more = Offsets(*(integer(numbers[i]) for i in (0, 1, 2, 4)))
        factors = self.cut(rows[3] if len(rows) > 3 else "", [10] * 5, "", scope)
        length = real(factors[2]) or 1.0
        own = Affine(((length, 0, 0), (0, length, 0), (0, 0, length)))
        tran = integer(self.cut(rows[4] if len(rows) > 4 else "", [10], "", scope)[0])
        if tran:
            own = own.then(self.transformations.get(tran, Affine()))
        self.include(rows[0].strip(), file, scope, offsets.plus(more), own.then(frame) if frame else own)

    def parameters(self, block, scope):
        options = block.word.split("_")[1:]
        into = scope.local if "LOCAL" in options else self.globals
        if "DUPLICATION" in options:
            return
        for _, line in block.rows:
            line = line.rstrip("\r")
            if "EXPRESSION" in options:
                first, rest = line.split(",", 1) if "," in line[:11] else (line[:10], line[10:80])
                if line[:1] != " " or not into:
                    name = re.sub(r"^\s*[RICric]\s+|^\s*[RICric](?=\w)", "", first, count=1).strip().lower()
                    try:
                        into[name] = evaluate(rest, scope)
                    except (ValueError, KeyError, SyntaxError, ZeroDivisionError, OverflowError):
                        pass
                continue
            fields = [f.strip() for f in line.split(",")] if "," in line else [line[i:i + 10].strip() for i in range(0, 80, 10)]
            for i in range(0, len(fields) - 1, 2):
                if not fields[i]:
                    continue
                kind, name = fields[i][0].upper(), fields[i][1:].strip().lower()
                try:
                    value = self.replaced(fields[i + 1], scope)
                    into[name] = value if kind == "C" else integer(value) if kind == "I" else real(value)
                except ValueError:
                    pass

    def transformation(self, block, scope, offsets):
        rows = block.rows[1:] if "TITLE" in block.word else block.rows
        if not rows:
            return
        tran, total = integer(self.cut(rows[0][1], [10], block.suffix, scope)[0]), Affine()
        steps = []
        for number, line in rows[1:]:
            f = self.cut(line, [10] * 8, block.suffix, scope)
            name, a = f[0].upper(), [real(v) for v in f[1:8]]
            if name == "TRANSL":
                steps.append(Affine(shift=tuple(a[:3])))
            elif name == "SCALE":
                s = [v or 1.0 for v in a[:3]]
                steps.append(Affine(((s[0], 0, 0), (0, s[1], 0), (0, 0, s[2]))))
            elif name == "ROTATE" and any(a[:3]):
                steps.append(rotation(a[:3], a[3:6], a[6]))
            elif name == "MIRROR":
                n = unit(minus(a[3:6], a[:3]))
                rows3 = tuple(tuple((i == j) - 2 * n[i] * n[j] for j in range(3)) for i in range(3))
                mirrored = Affine(rows3)
                steps.append(Affine(rows3, minus(a[:3], mirrored.to_basic(a[:3]))))
            else:
                self.deck.unread.append((self.deck.files[-1].relative, number + 1, name))
        for step in steps:  # the manual applies them in the order given
            total = total.then(step)
        self.transformations[tran] = total

    def nodes(self, file, block, scope, offsets, frame):
        w = {"+": (20, 20), "%": (10, 16)}.get(block.suffix, (8, 16))
        bounds = tuple((w[0] + i * w[1], w[0] + (i + 1) * w[1]) for i in range(3))
        for number, line in block.rows:
            if "," in line or "&" in line or "\t" in line:
                f = self.cut(line, [8, 16, 16, 16], block.suffix, scope)
                id, p, layout = integer(f[0]), tuple(real(v) for v in f[1:4]), "comma" if "," in line else bounds
            else:
                id, layout = integer(line[:w[0]]), bounds
                p = tuple(real(line[a:b].rstrip("\r")) for a, b in bounds)
            self.deck.add_node(Node(id + offsets.node if id else id, p, frame, file, (number,), layout))

    def elements(self, file, block, scope, offsets):
        words = block.word.split("_")[1:]
        cls, options = words[0].lower(), words[1:]
        reader = getattr(self, "element_" + cls, None)
        if cls == "mass":
            for number, line in block.rows:
                self.deck.count("MASS")
        elif reader:
            reader(file, block, scope, offsets, options)
        else:
            self.deck.count("_".join(words))

    def ids(self, fields, o):
        return integer(fields[0]) + o.element, integer(fields[1]) + o.part

    def element_shell(self, file, block, scope, o, options):
        rows, i = block.rows, 0
        thick = "THICKNESS" in options or "BETA" in options or "MCID" in options
        while i < len(rows):
            first = i
            f = self.cut(rows[i][1], [8] * 10, block.suffix, scope)
            id, part = self.ids(f, o)
            nodes = [integer(v) for v in f[2:10]]
            i += 1
            if thick:
                i += 1 + (any(nodes[4:]) and "THICKNESS" in options)
            i += ("OFFSET" in options) + ("DOF" in options)
            if "COMPOSITE" in options:
                while i < len(rows) and ("." in rows[i][1] or len(rows[i][1].split()) < 3):
                    i += 1
            corners = [n for k, n in enumerate(nodes[:4]) if n and n not in nodes[:k]]
            if any(nodes[4:]):  # one mid-side node is enough for the form, whatever else is missing
                kind = "SHELL_TRI_6n" if len(corners) == 3 else "SHELL_QUAD_8n"
            else:
                kind = "SHELL_TRI" if len(corners) == 3 else "SHELL_QUAD"
            nodes = tuple(n + o.node if n else 0 for n in nodes)
            self.add_element("shell", kind, id, part, nodes, file, rows[first:i])

    def element_beam(self, file, block, scope, o, options):
        extra = sum(k in options for k in ("THICKNESS", "SECTION", "SCALAR", "SCALR", "PID", "OFFSET", "ORIENTATION", "WARPAGE"))
        extra += 2 * ("ELBOW" in options)
        rows = block.rows
        for i in range(0, len(rows), 1 + extra):
            f = self.cut(rows[i][1], [8] * 10, block.suffix, scope)
            id, part = self.ids(f, o)
            nodes = tuple(integer(v) + o.node if integer(v) else 0 for v in f[2:5])
            self.add_element("beam", "BEAM", id, part, nodes, file, rows[i:i + 1 + extra])

    def element_solid(self, file, block, scope, o, options):
        rows, i = block.rows, 0
        extra = 2 * ("ORTHO" in options) + ("DOF" in options)
        while i < len(rows):
            first = i
            f = self.cut(rows[i][1], [8] * 10, block.suffix, scope)
            id, part = self.ids(f, o)
            nodes = [integer(v) for v in f[2:10]]
            i += 1
            if not any(nodes) and i < len(rows):
                nodes = [integer(v) for v in self.cut(rows[i][1], [8] * 10, block.suffix, scope)]
                i += 1 + ("H20" in options)
            i += extra
            corners = len({n for n in nodes if n})
            self.add_element("solid", SOLIDS.get(corners, "SOLID"), id, part, tuple(n + o.node if n else 0 for n in nodes), file, rows[first:i])

    def one_card(self, cls, kind, count, file, block, scope, o):
        for number, line in block.rows:
            f = self.cut(line, [8] * 10, block.suffix, scope)
            id, part = self.ids(f, o)
            nodes = tuple(integer(v) + o.node for v in f[2:2 + count] if integer(v))
            self.add_element(cls, kind, id, part, nodes, file, [(number, line)])

    def element_discrete(self, file, block, scope, o, options):
        self.one_card("discrete", "DISCRETE", 2, file, block, scope, o)

    def element_tshell(self, file, block, scope, o, options):
        self.one_card("tshell", "TSHELL", 8, file, block, scope, o)

    def element_sph(self, file, block, scope, o, options):
        for number, line in block.rows:  # the particle's id is its node's
            f = self.cut(line, [8] * 3, block.suffix, scope)
            id, part = self.ids(f, o)
            self.add_element("sph", "SPH", id, part, (id,), file, [(number, line)])

    def add_element(self, cls, kind, id, part, nodes, file, rows):
        self.deck.count(kind)
        self.deck.elements.append(Element(cls, kind, id, part, nodes, file, tuple(n for n, _ in rows)))

    def parts(self, block, scope, offsets):
        options = block.word.split("_")[1:]
        rows, i = block.rows, 0
        while i + 1 < len(rows):
            fields = self.cut(rows[i + 1][1], [10] * 8, block.suffix, scope)
            if not fields[0]:
                return
            self.deck.parts.add(integer(fields[0]) + offsets.part)
            i += 2
            if "INERTIA" in options:
                turned = integer(self.cut(rows[i][1], [10] * 6, block.suffix, scope)[4]) if i < len(rows) else 0
                i += 3 + (turned == 1)
            i += sum(k in options for k in ("REPOSITION", "CONTACT", "PRINT", "ATTACHMENT"))
            if "COMPOSITE" in options:
                return

    def sets(self, file, block, scope, offsets):
        words = block.word.split("_")[1:]
        kind = words[0].lower()
        rows = block.rows[1:] if "TITLE" in words else block.rows
        if kind not in ("node", "shell", "beam", "solid", "part", "segment", "discrete", "tshell") or not rows or "GENERAL" in words or "ADD" in words:
            return
        base = {"node": offsets.node, "segment": offsets.node, "part": offsets.part}.get(kind, offsets.element)
        id = integer(self.cut(rows[0][1], [10] * 5, block.suffix, scope)[0]) + offsets.set
        entry = self.deck.set_named(kind, id, file)
        for number, line in rows[1:]:
            f = self.cut(line, [10] * 8, block.suffix, scope)
            entry.lines.append(number)
            try:
                if kind == "segment":
                    corners = tuple(integer(v) + base for v in f[:4])
                    entry.members.add(corners)
                    continue
                values = [integer(v) for v in f if v]
            except ValueError:
                self.deck.unread.append((self.deck.files[file].relative, number + 1, block.word))
                continue
            if "GENERATE" in words:
                entry.ranges += [(a + base, b + base) for a, b in zip(values[::2], values[1::2]) if a and b]
            else:
                entry.members.update(v + base for v in values[:1 if "COLUMN" in words else 8] if v)


def rotation(axis, point, degrees):
    a, t = unit(axis), math.radians(degrees)
    c, s = math.cos(t), math.sin(t)
    rows = tuple(tuple(c * (i == j) + (1 - c) * a[i] * a[j] + s * (0 if i == j else (-a[2], a[1], a[2], -a[0], -a[1], a[0])[
        {(0, 1): 0, (0, 2): 1, (1, 0): 2, (1, 2): 3, (2, 0): 4, (2, 1): 5}[(i, j)]]) for j in range(3)) for i in range(3))
    return Affine(rows, minus(point, Affine(rows).to_basic(point)))


def read(path):
    reader = Reader(path)
    reader.read_file(path, Scope(None, reader.globals), Offsets(), None)
    return reader.deck
