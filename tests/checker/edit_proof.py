"""Which entities and lines differ between a deck before and after an edit, and whether everything that differs had to.

compare(before, after, expected) with expected as of EXPECT.json, every member optional:
  "moved": {"by": [x, y, z], "nodes": "all" | [ids], "part": id}    exactly these nodes moved by this much, in the basic system
  "moved_by_node": {id: [x, y, z]}                                 or each by its own
  "rim_may_stay": true                                             of the moved ones, those that elements outside share may have stayed
  "moved_freely": true                                            nodes may have moved anywhere (after a relaxation, a repair)
  "held": [ids]                                                    of the moved ones, those that must not have moved
  "nodes_added", "elements_added", "elements_removed", "elements_changed": n or "any"   default 0
  "memberships": true                                               new entities are in the sets they must be in (default when any is added)
The report: "wrong" (sentences, empty when all is proved) and what was found.

What must hold of any edit:
- Lines that belong to no changed, new or removed card are the same bytes in the same order: file by file, includes too.
- A changed node's line differs in the fields of the coordinates that moved and nowhere else; its line end stays.
- A coordinate has all digits its field can hold.
- A weld's node that lies on a sheet may have moved as the sheet under it did.
- Node ids are unique; a new id is outside every range that a set of another meaning generates.
"""
import math
import re

import nastran
import welds
from ancestry import SHELL_CLASSES, Ancestry  # noqa: F401
from deck_text import real

MOST_TOLD = 5


class Proof:
    def __init__(self, before, after, expected):
        self.before, self.after, self.expected = before, after, expected
        self.ancestry = Ancestry(before, after, expected.get("moved_freely", False))
        self.wrong, self.untold = [], 0
        self.found = {"nodes_moved": 0, "nodes_added": 0, "nodes_removed": 0, "elements_added": 0, "elements_removed": 0,
                      "elements_changed": 0, "lines_changed": 0, "files_changed": []}

    def say(self, sentence):
        if len(self.wrong) < 20:
            self.wrong.append(sentence)
        else:
            self.untold += 1

    def report(self):
        if self.untold:
            self.wrong.append(f"and {self.untold} more")
        return {"wrong": self.wrong, "found": self.found}


def compare(before, after, expected):
    proof = Proof(before, after, expected)
    if [f.relative for f in before.files][1:] != [f.relative for f in after.files][1:]:
        proof.say(f"the files are {[f.relative for f in after.files]}, not {[f.relative for f in before.files]}")
        return proof.report()
    moved, added, removed = compare_nodes(proof)
    elements = compare_elements(proof)
    compare_lines(proof, moved, added, removed, elements)
    check_new_ids(proof, added, elements[1])
    check_sets(proof, added, removed, elements)
    if added or elements[1]:
        check_memberships(proof, added, elements)
    return proof.report()


# Nodes -------------------------------------------------------------------------------------------------------------------------------

def same_card(a, b, before, after):
    lines, others = before.files[a.file].lines, after.files[b.file].lines
    return len(a.lines) == len(b.lines) and all(lines[i] == others[j] for i, j in zip(a.lines, b.lines))


def wanted_displacements(proof):
    """{id: displacement} that the edit must have made, or None where it may move any node."""
    if proof.expected.get("moved_freely"):
        return None
    if "moved_by_node" in proof.expected:
        return {int(id): tuple(by) for id, by in proof.expected["moved_by_node"].items()}
    moved = proof.expected.get("moved")
    if not moved:
        return {}
    deck = proof.before
    if "part" in moved:
        ids = {n for e in deck.elements if e.part == moved["part"] and e.cls in ("shell", "sh3n", "element") for n in e.nodes if n in deck.nodes}
    elif moved.get("nodes", "all") == "all":
        ids = deck.nodes.keys()
    else:
        ids = moved["nodes"]
    held = set(proof.expected.get("held", ()))
    return {id: tuple(moved["by"]) for id in ids if id not in held}


def compare_nodes(proof):
    before, after = proof.before, proof.after
    wanted = wanted_displacements(proof)
    rim = shared_nodes(before, wanted) if proof.expected.get("rim_may_stay") else ()
    moved, sheets = [], None
    for id, a in before.nodes.items():
        b = after.nodes.get(id)
        if b is None:
            continue
        if a.local == b.local and same_card(a, b, before, after):
            if wanted and id in wanted and any(wanted[id]) and moved_enough(a, wanted[id]) and id not in rim:
                proof.say(f"node {id} should have moved by {wanted[id]}")
            continue
        moved.append(id)
        if wanted is not None and id not in wanted:
            sheets = sheets or welds.Sheets(before, wanted)
            by = sheets.carried(id)
            if by is not None and any(by):
                check_position(proof, id, a, b, {id: by}, 1e-14)  # two ways to mix the same shares round differently
                continue
        check_position(proof, id, a, b, wanted)
    added = [id for id in after.nodes if id not in before.nodes]
    removed = [id for id in before.nodes if id not in after.nodes]
    proof.found.update(nodes_moved=len(moved), nodes_added=len(added), nodes_removed=len(removed))
    allowed = proof.expected.get("nodes_added", 0)
    if allowed != "any" and len(added) != allowed:
        proof.say(f"{len(added)} nodes were added, not {allowed}: {added[:MOST_TOLD]}")
    if removed and proof.expected.get("elements_removed", 0) == 0:
        proof.say(f"{len(removed)} nodes are gone: {removed[:MOST_TOLD]}")
    return moved, added, removed


def shared_nodes(deck, ids):
    """Of the nodes, those that elements with other nodes share."""
    return {n for e in deck.elements if any(m and m not in ids for m in e.nodes) for n in e.nodes if n in ids}


def moved_enough(node, by):
    """Whether the displacement is more than the least digit of the coordinates' fields."""
    p = node.basic()
    return any(abs((x + d) - x) > 1e-6 * max(1.0, abs(x)) for x, d in zip(p, by))


def check_position(proof, id, a, b, wanted, rounding=3e-16):
    if wanted is None:
        return
    if id not in wanted:
        proof.say(f"node {id} moved from {a.basic()} to {b.basic()}, and shouldn't have")
        return
    target = tuple(x + d for x, d in zip(a.basic(), wanted[id]))
    local = a.frame.from_basic(target) if a.frame else target
    found = b.frame.from_basic(b.basic()) if b.frame else b.local
    texts = coordinate_texts(proof.after, b)
    for axis in range(3):
        error = abs(found[axis] - local[axis])
        if getattr(a.frame, "kind", "") and axis:
            error = min(error, abs(error - 360.0))
        width = len(texts[axis][1]) if texts else 16
        if error > rounding * abs(local[axis]) and error > allowed_error(local[axis], width, texts[axis][0] if texts else "", a.frame):
            proof.say(f"node {id}, coordinate {axis + 1}: '{texts[axis][1] if texts else found[axis]}' is not {local[axis]!r}")


def coordinate_texts(deck, node):
    """[(style, text of the field)]"""
    return [(s, deck.files[node.file].lines[line][begin:end].rstrip("\r")) for s, line, begin, end in coordinate_fields(deck, node)] or None


def coordinate_fields(deck, node):
    """[(style, line, begin, end)] of the three coordinates; a field may end after its line does."""
    if isinstance(node.layout, tuple):
        return [("fixed", node.lines[0], begin, end) for begin, end in node.layout]
    line = deck.files[node.file].lines[node.lines[0]]
    if node.layout == "comma":
        out, at = [], line.find(",") + 1
        for _ in range(3):
            end = line.find(",", at)
            end = end if end >= 0 else len(line.rstrip("\r"))
            out.append(("comma", node.lines[0], min(at, end), end))
            at = end + 1
        return out
    if node.layout == "replicated":
        return []
    return [(node.layout, *f) for f in nastran.coordinate_fields(deck, node)]


def allowed_error(value, width, style, frame):
    """What rounding to the field's width must lose, and what the arithmetic of a coordinate system may."""
    if style == "comma":
        width = 16  # free fields hold no more than fixed ones (LS-DYNA's manual)
    elif style.startswith("free"):
        width = 16 if style.endswith("*") else 8
    elif style == "small":
        width = 8
    slack = (1e-11 if frame else 4e-16) * max(1.0, abs(value)) * (100 if getattr(frame, "kind", "") else 1)
    return 1.0001 * best_error(value, width, style) + slack


def best_error(value, width, style):
    """The error of the nearest number that fits in the field: fixed point, or an exponent ("e" may be left out in Nastran)."""
    best = abs(value)
    fixed = f"{value:.{width}f}"
    if 1e-4 < best < 10 ** (width - 3):  # as many decimals as there is room for, which no exponent betters
        room = width - fixed.index(".") - 1 + (best < 1)
        return abs(real(f"{value:.{room}f}") - value)
    for digits in range(width):
        texts = [f"{value:.{digits}f}"]
        mantissa, exponent = f"{value:.{digits}e}".split("e")
        mantissa += "" if "." in mantissa else "."
        short = f"{int(exponent):+d}"
        texts.append(mantissa + ("" if style in ("small", "large", "free", "free*") else "e") + (short if style != "fixed" else short.lstrip("+")))
        for text in texts:
            text += "" if "." in text else "."
            text = re.sub(r"^(-?)0(\.\d)", r"\1\2", text)
            if len(text) <= width:
                best = min(best, abs(real(text) - value))
    return best


# Elements ----------------------------------------------------------------------------------------------------------------------------

def keyed(deck):
    out = {}
    for e in deck.elements:
        out.setdefault((e.cls, e.id), []).append(e)
    return out


def compare_elements(proof):
    """Changed, added, removed: [(element before, element after)], [element], [element]."""
    a, b = keyed(proof.before), keyed(proof.after)
    changed, added, removed = [], [], []
    for key, olds in a.items():
        news = b.get(key, [])
        removed += olds[len(news):]
        for old, new in zip(olds, news):
            if (old.kind, old.part, old.nodes) != (new.kind, new.part, new.nodes) or not same_card(old, new, proof.before, proof.after):
                changed.append((old, new))
    for key, news in b.items():
        added += news[len(a.get(key, [])):]
    proof.found.update(elements_added=len(added), elements_removed=len(removed), elements_changed=len(changed))
    for what, found in (("added", added), ("removed", removed), ("changed", changed)):
        allowed = proof.expected.get("elements_" + what, 0)
        if allowed != "any" and len(found) != allowed:
            proof.say(f"{len(found)} elements were {what}, not {allowed}")
    for old, new in changed:
        if old.part != new.part:
            proof.say(f"{old.kind} {old.id} went from part {old.part} to {new.part}")
    return changed, added, removed


# Lines -------------------------------------------------------------------------------------------------------------------------------

def compare_lines(proof, moved, added, removed, elements):
    before, after = proof.before, proof.after
    mine, theirs = {}, {}  # file: lines that belong to cards that differ

    def take(into, card):
        into.setdefault(card.file, set()).update(card.lines)

    for id in moved:
        take(mine, before.nodes[id])
        take(theirs, after.nodes[id])
        check_node_lines(proof, before.nodes[id], after.nodes[id])
    for id in removed:
        take(mine, before.nodes[id])
    for id in added:
        take(theirs, after.nodes[id])
    for old, new in elements[0]:
        take(mine, old)
        take(theirs, new)
    for e in elements[1]:
        take(theirs, e)
    for e in elements[2]:
        take(mine, e)
    grown = bool(added or elements[1] or elements[2])
    for i, (a, b) in enumerate(zip(before.files, after.files)):
        if a.data == b.data:
            continue
        proof.found["files_changed"].append(b.relative)
        compare_file(proof, i, a, b, mine.get(i, set()), theirs.get(i, set()), grown)


def compare_file(proof, i, a, b, mine, theirs, grown):
    if not grown:
        differ = [n for n, (x, y) in enumerate(zip(a.lines, b.lines)) if x != y]
        proof.found["lines_changed"] += len(differ)
        if len(a.lines) != len(b.lines):
            proof.say(f"{b.relative} has {len(b.lines)} lines, not {len(a.lines)}")
        for n in differ:
            if n not in theirs or n not in mine:
                proof.say(f"{b.relative}:{n + 1} differs and belongs to no card that changed: '{b.lines[n][:80]}'")
        return
    rest = [(n, l) for n, l in enumerate(a.lines) if n not in mine]
    others = [(n, l) for n, l in enumerate(b.lines) if n not in theirs]
    twins = Twins(proof, a)
    sets_before, sets_after = set_lines(proof.before, i), set_lines(proof.after, i)
    sets_after |= {s.title for key, s in proof.after.sets.items() if s.file == i and key not in proof.before.sets}
    x = y = 0
    changed = len(mine) + len(theirs)
    while y < len(others) or x < len(rest):
        old, new = rest[x] if x < len(rest) else None, others[y] if y < len(others) else None
        if old and new and old[1] == new[1]:
            x, y = x + 1, y + 1
        elif old and new and gained_pair(proof, old, new):
            x, y, changed = x + 1, y + 1, changed + 2
        elif new and new[0] in sets_after:
            y, changed = y + 1, changed + 1
        elif old and old[0] in sets_before:
            x, changed = x + 1, changed + 1
        elif new and twins.has(new[1]):
            y, changed = y + 1, changed + 1
        elif new and is_heading(new[1]):  # a block for the new cards
            y, changed = y + 1, changed + 1
        elif old and is_heading(old[1]):  # a block whose last card went
            x, changed = x + 1, changed + 1
        else:
            place = f"{b.relative}:{new[0] + 1} '{new[1][:60]}'" if new else f"the end of {b.relative}"
            proof.say(f"{place} stands where {a.relative}:{old[0] + 1} '{old[1][:60]}' should" if old else f"{place} is new and no card")
            break
    proof.found["lines_changed"] += changed


class Twins:
    """Cards of single nodes, as an initial velocity: a new node may get one like that of a node beside it, but for the id."""
    CARD = re.compile(r"^(\s*)(\d+)(\D.*|)$")

    def __init__(self, proof, file):
        self.proof, self.file, self.known, self.loads = proof, file, None, None

    def has(self, line):
        if line.upper().startswith("PLOAD4"):
            return self.has_load(line)
        card = self.of_node(line)
        if not card or card[0] not in self.proof.after.nodes or card[0] in self.proof.before.nodes:
            return False
        if self.known is None:
            self.known = {c for c in map(self.of_node, self.file.lines) if c}
        return any((n, card[1]) in self.known for n in self.old_about(card[0]))

    def old_about(self, node):
        """The nodes of before to which a way leads over new ones: an edge may have been divided into several."""
        seen, reached = {node}, [node]
        for n in reached:
            for other in {o for e in self.proof.after.elements if n in e.nodes for o in e.nodes if o} - seen:
                seen.add(other)
                if other not in self.proof.before.nodes:
                    reached.append(other)
        return seen & self.proof.before.nodes.keys()

    def of_node(self, line):
        """(node, what else the card says), of a card that begins with a node or of a Nastran constraint of one."""
        line = line.rstrip("\r")
        if line.upper().startswith(("SPC ", "SPC,")):
            name, load, node, *rest = [f.strip() for f in (line.split(",") if "," in line else (line[i:i + 8] for i in range(0, 72, 8)))]
            return (int(node), (name, load, *(f for f in rest if f))) if node.isdigit() else None
        card = self.CARD.match(line)
        return (int(card.group(2)), card.group(3)) if card else None

    def has_load(self, line):
        """A load on an element: a new one may have a card like that of an old one, which may have been for a range of them."""
        load = self.load(line)
        if not load or load[1] != load[2] or load[1] not in {e.id for e in self.proof.after.elements} - {e.id for e in self.proof.before.elements}:
            return False
        if self.loads is None:
            self.loads = {l for l in map(self.load, self.file.lines) if l}
        parts = {e.part for e in self.proof.after.elements if e.id == load[1]}
        return any(load[0] == k[0] and any(k[1] <= e.id <= k[2] and e.part in parts for e in self.proof.before.elements) for k in self.loads)

    @staticmethod
    def load(line):
        """((name, set, values), first and last element) of a PLOAD4 card of one line."""
        line = line.rstrip("\r")
        fields = [f.strip() for f in (line.split(",") if "," in line else (line.expandtabs(8)[i:i + 8] for i in range(0, 72, 8)))]
        fields += [""] * (9 - len(fields))
        if fields[0].upper() != "PLOAD4" or not fields[2].isdigit():
            return None
        last = int(fields[8]) if fields[7].upper() == "THRU" and fields[8].isdigit() else int(fields[2])
        return (tuple(fields[:2] + fields[3:7]), int(fields[2]), last)


def set_lines(deck, file):
    return {n for s in deck.sets.values() if s.file == file for n in s.lines}


def is_heading(line):
    return line.startswith(("*NODE", "*ELEMENT", "*SET", "*NSET", "*ELSET", "/NODE", "/SHELL", "/SH3N", "/GR"))


def check_node_lines(proof, a, b):
    """Outside its coordinates a node's lines are the same bytes; a coordinate that has the same value has the same text."""
    lines, others = proof.before.files[a.file].lines, proof.after.files[b.file].lines
    if len(a.lines) != len(b.lines):
        proof.say(f"node {a.id} stands on {len(b.lines)} lines, not {len(a.lines)}")
        return
    spans, new_spans = coordinate_fields(proof.before, a), coordinate_fields(proof.after, b)
    for k, (i, j) in enumerate(zip(a.lines, b.lines)):
        old, new = lines[i], others[j]
        if old.endswith("\r") != new.endswith("\r"):
            proof.say(f"node {a.id}: its line end changed")
        mine = [s[2:] for s in spans if s[1] == i]
        theirs = [s[2:] for s in new_spans if s[1] == j]
        if outside(old, mine) != outside(new, theirs) and "\t" not in old:
            proof.say(f"node {a.id}: '{new.rstrip()}' differs from '{old.rstrip()}' outside its coordinates")
    for axis, (s, t) in enumerate(zip(spans, new_spans)):
        old, new = lines[s[1]][s[2]:s[3]].rstrip("\r"), others[t[1]][t[2]:t[3]].rstrip("\r")
        if a.local[axis] == b.local[axis] and old != new and real(old) == real(new) and not a.frame:
            proof.say(f"node {a.id}: '{old}' became '{new}' though it has the same value")


def outside(line, spans):
    """The line without the fields, and without blanks that only fill up its end."""
    out, at = [], 0
    line = line.rstrip("\r")
    if spans and not any("," in line[:end] for _, end in spans):
        line = line.ljust(max(end for _, end in spans))  # a short line's fields are blank
    for begin, end in sorted(spans):
        out.append(line[at:begin])
        at = max(at, min(end, len(line)))
    out.append(line[at:])
    return "|".join(out).rstrip()


# New entities ------------------------------------------------------------------------------------------------------------------------

def check_new_ids(proof, nodes, elements):
    deck = proof.after
    if deck.duplicate_nodes > proof.before.duplicate_nodes:
        proof.say("a node id was given twice")
    ids = {}
    for e in deck.elements:
        ids[(e.cls, e.id)] = ids.get((e.cls, e.id), 0) + 1
    old = {(e.cls, e.id) for e in proof.before.elements}
    for e in elements:
        if ids[(e.cls, e.id)] > 1 or (e.cls, e.id) in old:
            proof.say(f"{e.kind} {e.id} is new and its id isn't its own")
    kinds = [("node", id) for id in nodes] + [(e.cls, e.id) for e in elements]
    for kind, id in kinds:
        for s in proof.before.sets.values():
            if s.kind == kind and any(a <= id <= b for a, b in s.ranges) and not inherits(proof, kind, id, s):
                proof.say(f"the new {kind} {id} falls into what set {s.id} generates")


def inherits(proof, kind, id, s):
    """Whether a new entity belongs in a set that generates its id: something it came from is in it."""
    def within(n):
        return n in s.members or any(a <= n <= b for a, b in s.ranges)
    if kind == "node":
        return any(within(n) for n in neighbours(proof, id))
    element = next(e for e in proof.after.elements if (e.cls, e.id) == (kind, id))
    return any(within(p.id) for p in proof.ancestry.parents(element))


def neighbours(proof, id):
    return {n for e in proof.after.elements if id in e.nodes for n in e.nodes if n in proof.before.nodes}


def edge_neighbours(proof, id):
    found = set()
    for e in proof.after.elements:
        if id in e.nodes:
            corners = [n for i, n in enumerate(e.nodes[:4]) if n and n not in e.nodes[:i]]
            i = corners.index(id) if id in corners else None
            found |= {corners[i - 1], corners[(i + 1) % len(corners)]} if i is not None else set()
    return found


def membership(deck, kind, id):
    return {s.id for s in deck.sets.values() if s.kind == kind and (id in s.members or any(a <= id <= b for a, b in s.ranges))}


def pair_users(deck, kind, id):
    return {p.name for p in deck.pairs if p.sets[kind][0] == id}


def expected_sets(proof, old, e):
    """The sets in which e, which comes from old, belongs: those of old, or, where these can't name e, the ones that go with them."""
    before, after = proof.before, proof.after
    if old.cls == e.cls or {old.cls, e.cls} != {"shell", "sh3n"}:
        return membership(before, e.cls, old.id)
    wanted = membership(before, e.cls, old.id)
    for id in membership(before, old.cls, old.id):
        users = pair_users(before, old.cls, id)
        new = {s.id for s in after.sets.values() if s.kind == e.cls and pair_users(after, e.cls, s.id) == users and (users or s.id == id)}
        if pair_users(after, old.cls, id) != users or len(new) != 1:
            proof.say(f"{old.kind} set {id} has no {e.kind} set that the same cards use")
        wanted |= new
    return wanted


def gained_pair(proof, old, new):
    """Whether a line of a card that used a set of one kind only now uses one of each kind and says the same otherwise."""
    for a in proof.before.pairs:
        for b in proof.after.pairs:
            if (a.file, a.line, b.line, a.name) != (b.file, old[0], new[0], b.name):
                continue
            filled = [kind for kind in a.sets if a.sets[kind][0] == 0 and b.sets[kind][0] != 0]
            if len(filled) == 1 and all(a.sets[k][0] == b.sets[k][0] != 0 for k in a.sets if k not in filled):
                begin, end = a.sets[filled[0]][1]
                return old[1][:begin].ljust(begin) + old[1][end:] == new[1][:begin] + new[1][end:]
    return False


def check_memberships(proof, nodes, elements):
    """A node on an edge is in the sets that both ends are in; a new element in those of the one it came from."""
    before, after = proof.before, proof.after
    edges = {}
    for e in before.elements:
        corners = [n for i, n in enumerate(e.nodes[:4]) if n and n not in e.nodes[:i]]
        for i, n in enumerate(corners):
            edges.setdefault(frozenset((n, corners[i - 1])), []).append(e)
    for id in nodes:
        around = sorted(neighbours(proof, id))
        p = after.nodes[id].basic()
        # Where other nodes moved too, old places say nothing of an edge that a new node divides.
        places = after if proof.expected.get("moved_freely") else before
        # Two edges away, the shell may have been divided along another line: at least one end has an edge to the node.
        beside = edge_neighbours(proof, id)
        ends = [(detour(places, a, b, p), a, b) for i, a in enumerate(around) for b in around[i + 1:]
                if frozenset((a, b)) in edges and (a in beside or b in beside)]
        for way, a, b in sorted(ends)[:1]:
            if way > 0.2:
                continue
            must = membership(before, "node", a) & membership(before, "node", b)
            lacking = must - membership(after, "node", id)
            if lacking:
                proof.say(f"the new node {id} between {a} and {b} isn't in the sets {sorted(lacking)[:MOST_TOLD]}")
    for e in proof.ancestry.loose(elements[1]):
        proof.say(f"the new {e.kind} {e.id} has no way over edges to an old one of part {e.part}")
    for e in elements[1]:
        came_from = proof.ancestry.parents(e)
        if not came_from:
            proof.say(f"the new {e.kind} {e.id} of part {e.part} comes from no element of its part")
        elif not any(expected_sets(proof, old, e) == membership(after, e.cls, e.id) for old in came_from):
            proof.say(f"the new {e.kind} {e.id} is in the sets {sorted(membership(after, e.cls, e.id))}, unlike any it came from")


def check_sets(proof, added, removed, elements):
    """A set gains nothing but what is new and loses nothing but what is gone."""
    new = {"node": set(added)}
    gone = {"node": set(removed)}
    for into, some in ((new, elements[1]), (gone, elements[2])):
        for e in some:
            into.setdefault(e.cls, set()).add(e.id)
    for into in (new, gone):
        into["case"] = set().union(*into.values())  # nodes or elements, the deck doesn't say
    for key, s in proof.before.sets.items():
        t = proof.after.sets.get(key)
        if t is None:
            if s.members - gone.get(s.kind, set()):
                proof.say(f"{s.kind} set {s.id} is gone")
            continue
        if s.kind == "segment":
            known = proof.after.nodes
            if any(n and n not in known and n in proof.before.nodes for corners in t.members for n in corners):
                proof.say(f"segment set {s.id} names a node that is gone")
            continue
        listed = {m for m in s.members | t.members}
        lost = {m for m in listed & s.members - t.members if not any(a <= m <= b for a, b in t.ranges)} - gone.get(s.kind, set())
        gained = listed & t.members - s.members - new.get(s.kind, set())
        gained = {m for m in gained if not any(a <= m <= b for a, b in s.ranges)}
        if lost or gained:
            proof.say(f"{s.kind} set {s.id} lost {sorted(lost)[:MOST_TOLD]} and gained {sorted(gained)[:MOST_TOLD]}")
        for m in t.members & gone.get(s.kind, set()):
            proof.say(f"{s.kind} set {s.id} still names {m}, which is gone")


def detour(deck, a, b, p):
    """How much longer the way from a to b over p is, of the edge's length."""
    a, b = deck.nodes[a].basic(), deck.nodes[b].basic()
    edge = math.dist(a, b)
    return (math.dist(a, p) + math.dist(p, b)) / edge - 1 if edge else math.inf
