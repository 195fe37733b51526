#!/usr/bin/env python3
"""Independent check of decks of every format: reads them with its own readers, so that it can check what the program reads and writes.

    check_deck.py counts DECK                         what is in a deck, includes followed, as one JSON object
    check_deck.py edit BEFORE AFTER EXPECT.json       which entities and lines differ between two decks, and whether all that differs
                                                      had to (see edit_proof.py for what EXPECT.json may say); status 1 if not
"""
import json
import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import abaqus  # noqa: E402
import edit_proof  # noqa: E402
import lsdyna  # noqa: E402
import nastran  # noqa: E402
import radioss  # noqa: E402
from deck_text import DeckError  # noqa: E402

READERS = {"ls-dyna": lsdyna.read, "nastran": nastran.read, "radioss": radioss.read, "abaqus": abaqus.read}


def format_of(path):
    """By the name's ending where that says it, otherwise by the first lines that do."""
    by_name = {".k": "ls-dyna", ".key": "ls-dyna", ".dyn": "ls-dyna", ".rad": "radioss", ".bdf": "nastran", ".nas": "nastran", ".fem": "nastran"}
    ending = os.path.splitext(path)[1].lower()
    if ending in by_name:
        return by_name[ending]
    with open(path, errors="replace") as f:
        for line in f:
            if re.match(r"\*KEYWORD|\$#|\*ELEMENT_", line, re.I):
                return "ls-dyna"
            if line.startswith(("#RADIOSS", "/BEGIN", "/NODE")):
                return "radioss"
            if re.match(r"\*(NODE|ELEMENT|HEADING|PART|MATERIAL|INCLUDE)\b", line, re.I) or line.startswith("**"):
                return "abaqus"
            if re.match(r"\s*(SOL|CEND|BEGIN|GRID|ID|NASTRAN|C[A-Z]+\d)\b", line, re.I):
                return "nastran"
    raise DeckError(f"{path}: of no format the checker knows")


def read(path):
    return READERS[format_of(path)](path)


def counts(deck, format):
    return {
        "format": format,
        "files": [f.relative for f in deck.files],
        "nodes": len(deck.nodes),
        "elements": deck.words,
        "parts_defined": len(deck.parts),
        "parts_with_elements": len(deck.parts_with_elements()),
        "missing_includes": deck.missing,
        "circular_includes": deck.circular,
        "duplicate_nodes": deck.duplicate_nodes,
        "missing_node_references": deck.undefined_nodes(),
        "crlf_lines": sum(l.endswith("\r") for f in deck.files for l in f.lines),
        "not_understood": [":".join(map(str, u)) for u in deck.unread[:20]],
    }


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "counts":
        print(json.dumps(counts(read(arguments[1]), format_of(arguments[1])), indent=1))
        return 0
    if len(arguments) == 4 and arguments[0] == "edit":
        with open(arguments[3]) as f:
            expected = json.load(f)
        report = edit_proof.compare(read(arguments[1]), READERS[format_of(arguments[1])](arguments[2]), expected)
        print(json.dumps(report, indent=1))
        return 1 if report["wrong"] else 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (DeckError, OSError) as error:
        sys.exit(f"check_deck.py: {error}")
