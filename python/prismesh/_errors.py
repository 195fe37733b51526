"""The exceptions of prismesh."""
from __future__ import annotations


class Error(Exception):
    """Something that could not be done as asked; nothing was changed by it.

    file: the file it is about, "expression" for an expression, or None; line: the line, counted from 1, in an expression the column, or None;
    message: a sentence.
    """

    def __init__(self, message: str, file: str | None = None, line: int | None = None):
        super().__init__(message, file, line)
        self.message = message
        self.file = file
        self.line = line

    def __str__(self) -> str:
        return ": ".join([":".join(str(part) for part in (self.file, self.line) if part is not None), self.message]).removeprefix(": ")


class Cancelled(Error):
    """The progress function returned False."""
