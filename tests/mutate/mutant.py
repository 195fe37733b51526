"""What a mutant is: plain data."""
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Part:
    """One piece of text that a mutant replaces: the bytes [start, end) of its file."""

    start: int
    end: int
    broken: bytes


@dataclass
class Mutant:
    file: str  # from the project's root
    line: int
    kind: str
    parts: tuple  # most have one; exchanged arguments have two
    wrapper: str = ""  # what the whole becomes: "" as it is, "bool", "void", or "eval" for vectors
    at_run_time: bool = False  # in a constexpr function
    number: int = 0  # of the switch, from 1; 0: not built
    state: str = ""  # not compiled, not reached, caught, slipped, no change of behaviour; empty: not judged
    before: str = field(default="", compare=False)  # the changed text, on one line
    after: str = field(default="", compare=False)

    def key(self):
        return (self.file, self.parts)


def shown(data, text, mutant):
    """The lines that a mutant changes, before and after, each on one line."""
    first = text.line_starts[mutant.line - 1]
    last_line = text.line_of(mutant.parts[-1].end)
    end = text.line_starts[last_line] if last_line < len(text.line_starts) else len(data)
    after, at = b"", first
    for part in mutant.parts:
        after += data[at : part.start] + part.broken
        at = part.end
    after += data[at:end]
    before = data[first:end]

    def one_line(piece):
        return b" ".join(piece.split()).decode("utf-8", "replace")

    return one_line(before), one_line(after)
