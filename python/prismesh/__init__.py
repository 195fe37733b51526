"""Edits shell models of crash simulation from scripts, as the command line does: see docs/python.md."""
from ._core import ChunkedArray, Document, State, __version__, diff, open
from ._errors import Cancelled, Error

for _class in (Cancelled, ChunkedArray, Document, Error, State):
    _class.__module__ = __name__
del _class

__all__ = ["Cancelled", "ChunkedArray", "Document", "Error", "State", "diff", "open"]
