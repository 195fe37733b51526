"""An exhibition's show: the kiosk edits the sample by itself, with a card for each step."""
import shutil
import subprocess

from programs import ROOT, Stop, program, shown, tell, tool

PICTURES = 16
PACE_S = 2.6  # the show of the sample is 42 s long


def exhibit(station):
    """Plays the show without a display, and checks from its trace that each step came and that the deck on the disk is as it was."""
    folder = station.out / "exhibition"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    deck = folder / "sample.k"
    tool("sample", "-o", deck)
    before = deck.read_bytes()
    settings = folder / "prismesh.toml"
    settings.write_text(f'[display]\nprofile = "anaglyph"\n[exhibition]\ndeck = "sample.k"\nshow = "{ROOT / "demo" / "show.jsonl"}"\n')
    done = subprocess.run([program("prismesh-kiosk"), "--config", settings, "--headless-frames", str(PICTURES), "--pace", str(PACE_S), "--shots", folder,
                           "--trace"], capture_output=True, text=True, stdin=subprocess.DEVNULL)  # fmt: skip
    if done.returncode != 0:
        raise Stop(f"the exhibition's kiosk said: {done.stderr.strip() or done.stdout.strip()[-200:]}")
    steps = [line for line in done.stdout.splitlines() if line.startswith("show ")]
    wanted = sum(1 for line in (ROOT / "demo" / "show.jsonl").read_text().splitlines() if line.startswith("{"))
    if len(steps) < wanted:
        raise Stop(f"the show went {len(steps)} of its {wanted} steps: {steps[-1:]}")
    if deck.read_bytes() != before:
        raise Stop("the show has changed the deck on the disk")
    tell(f"exhibition the kiosk plays a show of {wanted} steps on the sample until somebody comes; docs/exhibition.md")
    tell(f"  {shown(folder)}: {PICTURES} pictures of it, in red and cyan")
