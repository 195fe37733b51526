"""Writes a source in which every mutant stands beside what it breaks: (on(K) ? broken : original). Lines keep their numbers."""
from dataclasses import dataclass, field

SPACE = "::prismesh::mutant::"
WRAPPED = {"": b"(%s)", "bool": b"static_cast<bool>(%s)", "void": b"static_cast<void>(%s)", "eval": b"(%s).eval()"}


@dataclass
class Group:
    """All mutants that replace the same piece of text."""

    start: int
    end: int
    choices: list = field(default_factory=list)  # (mutant, broken)
    children: list = field(default_factory=list)
    written: tuple = (0, 0)  # where it stands in the new text

    def wrapper(self):
        wrappers = {mutant.wrapper for mutant, _ in self.choices}
        return next((w for w in ("void", "bool", "eval") if w in wrappers), "")


class Schemata:
    """`text`: the new source."""

    def __init__(self, data, mutants):
        self.data = data
        self.out = bytearray()
        self.groups = self.grouped(mutants)
        self.write(0, len(data), self.nested())
        self.text = bytes(self.out)

    @staticmethod
    def grouped(mutants):
        groups = {}
        for mutant in mutants:
            for part in mutant.parts:
                group = groups.setdefault((part.start, part.end), Group(part.start, part.end))
                group.choices.append((mutant, part.broken))
        return sorted(groups.values(), key=lambda group: (group.start, -group.end))

    def nested(self):
        """The outermost groups, each with the groups inside it. What overlaps by halves is left out."""
        top, open_groups = [], []
        for group in self.groups:
            while open_groups and open_groups[-1].end <= group.start:
                open_groups.pop()
            if open_groups and group.end > open_groups[-1].end:
                continue
            (open_groups[-1].children if open_groups else top).append(group)
            open_groups.append(group)
        return top

    def write(self, start, end, groups):
        at = start
        for group in groups:
            self.out += self.data[at : group.start]
            self.write_group(group)
            at = group.end
        self.out += self.data[at:end]

    def write_group(self, group):
        begin, wrapper = len(self.out), group.wrapper()
        self.out += b"("
        for mutant, broken in group.choices:
            switch = "on_at_run_time" if mutant.at_run_time else "on"
            self.out += f"{SPACE}{switch}({mutant.number}) ? ".encode() + WRAPPED[wrapper].replace(b"%s", broken or b"0") + b" : "
        before, after = WRAPPED[wrapper].split(b"%s")
        self.out += before
        self.write(group.start, group.end, group.children)
        self.out += after + b")"
        group.written = (begin, len(self.out))

    def mutants_at(self, offset):
        """Those of the innermost group about a place in the new text."""
        about = [group for group in self.groups if group.written[0] <= offset < group.written[1]]
        if not about:
            return []
        innermost = min(about, key=lambda group: group.written[1] - group.written[0])
        return [mutant for mutant, _ in innermost.choices]
