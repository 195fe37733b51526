#!/usr/bin/env python3
"""Generates man pages and completion from what the programs print for --help.

Usage: generate.py PROGRAMS OUT. PROGRAMS is the folder of the built programs. Into OUT go man1/, man8/ and bash-completion/.
The sections that --help has no words for are in scripts/manual/sections.
"""
import os
import sys
import time
from pathlib import Path

import completion
import help_text
import man_page

# The program, the section of its page, its line in whatis.
PROGRAMS = [
    ("prismesh", 1, "edit finite\\-element shell models for crash simulation"),
    ("prismesh-kiosk", 1, "show and edit the document of a Prismesh station"),
    ("prismesh-modeld", 8, "keep the document of a Prismesh station"),
    ("prismesh-deviced", 8, "run the eye tracker and the prism mask of a Prismesh station"),
    ("prismesh-intake", 8, "take models from the network"),
    ("prismesh-import", 8, "read one deck in a sandbox"),
    ("prismesh-setup", 8, "write what the kiosk sets a station up with"),
]


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main(programs, out):
    sections = Path(__file__).parent / "sections"
    # The packages set the time, so that a rebuilt page has the same bytes.
    seconds = os.environ.get("SOURCE_DATE_EPOCH")
    date = time.strftime("%B %Y", time.gmtime(int(seconds))) if seconds else ""
    for name, section, what in PROGRAMS:
        program = programs / name
        command = help_text.read(str(program), name)
        page = man_page.page(command, section=section, version=help_text.version(str(program)), date=date, what=what,
                             by_hand=(sections / f"{name}.roff").read_text(encoding="utf-8"))
        write(out / f"man{section}" / f"{name}.{section}", page)
        write(out / "bash-completion" / name, completion.bash(command))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
