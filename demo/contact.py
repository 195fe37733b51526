"""Contact between parts: pulls a bead through its neighbour, finds where they cross, and pushes it back."""
import json

from programs import Stop, figures, shown, tell, tool

# Of the sample with 2,000 shells: the closing plate's node is pulled through the rail.
SHELLS = 2000
PULL = [
    {"edit": "select", "expr": "5000104"},
    {"edit": "grow", "rings": 2},
    {"edit": "translate", "by": [0.09, 77.24, -0.02], "grab": 5000104},
]
SEPARATE = {"edit": "separate", "at": [347, 15, 146], "joined": True}


def edited(deck, edits, to):
    """Applies edits to a deck; returns the report of the last one."""
    arguments = [word for edit in edits for word in ("--edit", json.dumps(edit))]
    to.parent.mkdir(exist_ok=True)
    return json.loads(tool("edit", deck, *arguments, "-o", to, "--json").strip().splitlines()[-1])


def crossing(deck):
    """The perforations of a deck, the longest curve first."""
    return [region for region in figures("penetrations", deck)["regions"] if region["kind"] == "perforation"]


def push_apart(station):
    out = station.out / "contact"
    out.mkdir(parents=True, exist_ok=True)
    deck, pulled, apart = out / "sample.k", out / "pulled" / "sample.k", out / "apart" / "sample.k"
    tool("sample", "--elements", SHELLS, "-o", deck)
    before = crossing(deck)
    edited(deck, PULL, pulled)
    regions = crossing(pulled)
    if len(regions) <= len(before):
        raise Stop("the pull made nothing cross")
    worst = max(regions, key=lambda region: (region["depth"] or {"max": 0})["max"])
    tell("\ncontact   a bead of the closing plate is pulled through the rail")
    tell(f"  {worst['a']} and {worst['b']} cross along {worst['length']:.0f} mm, {worst['depth']['max']:.1f} mm deep: {worst['worst'][0]}, {worst['worst'][1]}")
    report = edited(pulled, [SEPARATE], apart)
    left = crossing(apart)
    if report["regions_removed"] != 1 or len(left) != len(before):
        raise Stop(f"separate removed {report['regions_removed']} regions and left {report['regions_left']}")
    tell(f"  separated: no node moved by more than {report['largest_move']:.1f} mm, and no shell fails that didn't")
    tell(f"  {shown(out)}: the deck, pulled/ and apart/; the kiosk marks the place in pulled/sample.k (Ctrl+K)")
