#!/usr/bin/env python3
"""Makes the pictures of docs/examples for the chain on the bumper beam: bumper_beam_signs.png and bumper_beam_mended.png.

    scripts/chain_pictures.py DECK [FOLDER]     DECK: Bumper_Beam_AP_meshed_0000.rad; FOLDER: where they are written, default docs/examples

The kiosk draws them without a screen, from a session that runs docs/examples/bumper_beam_stretch.jsonl: after the stretch, and at the end.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "demo"))
sys.dont_write_bytecode = True
from programs import Station, program, session  # noqa: E402

SCRIPT = ROOT / "docs" / "examples" / "bumper_beam_stretch.jsonl"


def picture(file, work):
    command = [program("prismesh-kiosk"), "--profile", "mono", "--size", "1200x750", "--headless-frames", "1", "--shots", work / "shots"]
    subprocess.run(list(map(str, command)), check=True, stdin=subprocess.DEVNULL)
    shutil.move(work / "shots" / "frame-0001.png", file)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    deck = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else ROOT / "docs" / "examples"
    work = pathlib.Path(tempfile.gettempdir()) / "prismesh-chain"  # the picture shows this name
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(mode=0o700)
    shutil.copy(deck, work)
    station = Station(work)
    try:
        session("open", work / deck.name)
        edits = SCRIPT.read_text().splitlines()
        for line in edits[:2]:
            session("edit", line)
        picture(folder / "bumper_beam_signs.png", work)
        for line in edits[2:-1]:  # the last line shows the other parts again
            session("edit", line)
        picture(folder / "bumper_beam_mended.png", work)
    finally:
        station.end()
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    main()
