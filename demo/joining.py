"""Joining: finds the flanges, puts welds between the ones that are there, and measures the joint and cuts it."""
import difflib
import json

from programs import Stop, figures, shown, tell, tool

SHELLS = 2000
LIKE = "beam:90000001"  # the sample's first spot weld
PARTS, PITCH = "3,4", 25


def weld(station):
    out = station.out / "joining"
    out.mkdir(parents=True, exist_ok=True)
    deck, welded = out / "sample.k", out / "welded.k"
    tool("sample", "--elements", SHELLS, "-o", deck)
    flanges = figures("flanges", deck)["flanges"]
    longest = flanges[0]
    tell(f"\njoining   {len(flanges)} flanges, the longest {longest['length']:.0f} mm long and {longest['width']['mean']:.0f} mm wide, of {' and '.join(longest['parts'])}")
    edit = {"edit": "weld", "flange": {"between": PARTS}, "pitch": PITCH, "like": LIKE}
    report = json.loads(tool("edit", deck, "--edit", json.dumps(edit), "-o", welded, "--json").strip().splitlines()[-1])
    lines = [line for line in difflib.ndiff(deck.read_text().splitlines(), welded.read_text().splitlines()) if line[:2] in ("- ", "+ ")]
    if report["welds_added"] == 0 or any(line.startswith("- ") for line in lines):
        raise Stop(f"{report['welds_added']} welds were added, or a line of the deck isn't as it was")
    tell(f"  {report['welds_added']} welds like {LIKE} between those of parts {PARTS}, {PITCH} mm apart; {report['spots_left']} places have one already")
    tell(f"  {len(lines)} lines more in the deck, and no other is changed")
    checked = figures("welds", welded)
    if checked["findings"]:
        raise Stop(checked["findings"][0]["words"])
    tell(f"  all {checked['welds']} welds join their sheets")
    at = longest["at"]
    section = figures("cross-section", welded, "--plane", f"x={at[0]}", "-o", out / "section.csv")
    if section["length"] <= 0:
        raise Stop("the plane cuts nothing")
    tell(f"  cut at x = {at[0]:.0f} mm: {len(section['curves'])} curves, {section['length']:.0f} mm")
    tell(f"  {shown(out)}: both decks and section.csv")
