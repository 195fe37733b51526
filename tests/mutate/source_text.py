"""A source's bytes: lines, and pieces brought onto one line."""
import bisect
import re

_TOKEN = re.compile(rb'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|//[^\n]*|/\*.*?\*/|\s+', re.S)


def flat(piece):
    """The piece on one line, without comments. None where that isn't possible: raw strings, preprocessor lines."""
    if b'R"' in piece or re.search(rb"^\s*#", piece, re.M):
        return None

    def shorter(match):
        text = match.group()
        return text if text[:1] in b"\"'" else b" "

    return _TOKEN.sub(shorter, piece).strip()


class SourceText:
    def __init__(self, data):
        self.data = data
        self.line_starts = [0] + [match.end() for match in re.finditer(rb"\n", data)]

    def line_of(self, offset):
        """From 1."""
        return bisect.bisect_right(self.line_starts, offset)

    def column_of(self, offset):
        """From 1."""
        return offset - self.line_starts[self.line_of(offset) - 1] + 1

    def line(self, number):
        end = self.line_starts[number] if number < len(self.line_starts) else len(self.data)
        return self.data[self.line_starts[number - 1] : end].rstrip(b"\n")
