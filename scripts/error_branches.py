"""Finds the branches that lead to an error: conditions of an `if` whose statement reports one, and statements that report one by themselves.

The text is read without a compiler: the words below are the names of this project's functions for errors, notes and warnings.
"""

import re

SAYS_ERROR = re.compile(r"\b(?:\w+_)?(?:fail|failed|failure|refus(?:e|al)|errors?|unexpected|notes?|warn|problem|complain|cancelled|throw)(?:_\w+)?\b")
QUOTED_OR_COMMENT = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/', re.S)
IF = re.compile(r"\b(?:if|while)\s*(?:constexpr\s*)?\(")
CLOSES = {"(": ")", "{": "}", "[": "]"}


def says_error(text):
    return bool(SAYS_ERROR.search(text))


def without_quotes(text):
    """The text with strings, characters and comments blanked, each as long as before."""
    return QUOTED_OR_COMMENT.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


class Guard:
    """One `if` or `while`: the places of its condition, its statement and its `else` in the text."""

    def __init__(self, text, opening):
        self.opening = opening
        self.closing = end_of(text, opening)
        self.end = statement_end(text, self.closing + 1)
        self.statement = text[self.closing + 1 : self.end]
        found = re.compile(r"\s*else\b").match(text, self.end)
        self.otherwise = text[found.end() : statement_end(text, found.end())] if found else ""


def end_of(text, opening):
    """The place of the bracket that closes the one at `opening`."""
    expected = []
    for place in range(opening, len(text)):
        if text[place] in CLOSES:
            expected.append(CLOSES[text[place]])
        elif expected and text[place] == expected[-1]:
            expected.pop()
            if not expected:
                return place
    return len(text) - 1


def statement_end(text, place):
    """The end of the statement that begins at or after `place`."""
    while place < len(text) and text[place].isspace():
        place += 1
    if text[place : place + 1] == "{":
        return end_of(text, place) + 1
    while place < len(text) and text[place] != ";":
        place = end_of(text, place) + 1 if text[place] in CLOSES else place + 1
    return place + 1


class ErrorBranches:
    """The guards of one source."""

    def __init__(self, source):
        self.text = without_quotes(source)
        self.starts = [0]
        for line in self.text.split("\n"):
            self.starts.append(self.starts[-1] + len(line) + 1)
        self.guards = [Guard(self.text, found.end() - 1) for found in IF.finditer(self.text)]

    def place(self, line, column):
        return self.starts[line - 1] + column - 1

    def way_to_error(self, line, column):
        """Which value of the condition at that place leads to an error: True, False, or None if neither does or it belongs to no `if`."""
        place = self.place(line, column)
        around = [guard for guard in self.guards if guard.opening < place < guard.closing]
        if not around:
            return None
        guard = max(around, key=lambda one: one.opening)
        negated = self.negated(guard.opening, place)
        if says_error(guard.statement):
            return not negated
        return negated if says_error(guard.otherwise) else None

    def negated(self, opening, place):
        """Whether an odd number of `!( … )` enclose the place."""
        count = 0
        for found in re.compile(r"!\s*\(").finditer(self.text, opening, place):
            count += end_of(self.text, found.end() - 1) > place
        return count % 2 == 1

    def guarded_by(self, line, column):
        """The places of the conditions whose statement contains that place, as (opening, closing)."""
        place = self.place(line, column)
        return [(one.opening, one.closing) for one in self.guards if one.closing < place < one.end]
