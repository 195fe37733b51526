"""The way of the paper's figure 12, (a) to (f), as one script of edits on the sample: a rail is stretched, its bad elements are shown, repaired and
relaxed, a part that was pushed into its neighbour is separated from it, the longer flange is welded, and the result is compared."""
import json

from programs import ROOT, Stop, figures, shown, tell, tool

SCRIPT = ROOT / "demo" / "whole_way.jsonl"
# Each stage of the figure: its letter, how many edits of the script are done by then, what it shows, and how it is drawn.
STAGES = [
    ("a", 0, "the deck", []),
    ("b", 2, "the rail's end stretched by 150 mm", []),
    ("c", 2, "its bad elements", ["--colour", "quality"]),
    ("d", 4, "repaired and relaxed", ["--colour", "quality"]),
    ("pushed", 5, "the crossmember lengthened through the closing plate", []),
    ("e", 6, "separated from it", []),
    ("f", 7, "the longer flange welded", ["--colour", "distance-to-original"]),
]


def counts(deck, size):
    """Bad elements, places where parts cross, welds and their faults, as the programs count them in a deck. `size`: what shells should be."""
    metrics, welds = figures("check", deck, "--target-size", size), figures("welds", deck)
    crossing = [region for region in figures("penetrations", deck)["regions"] if region["kind"] == "perforation"]
    kinds = {name.replace("_", " "): each["warn"] + each["fail"] for name, each in metrics["metrics"].items() if each["warn"] + each["fail"] > 0}
    return {"warn": metrics["warn"], "fail": metrics["fail"], "kinds": kinds, "cross": len(crossing), "welds": welds["welds"],
            "faults": len(welds["findings"])}  # fmt: skip


def whole_way(station, with_pictures):
    out = station.out / "figure12"
    out.mkdir(parents=True, exist_ok=True)
    deck = out / "a.k"
    tool("sample", "-o", deck)
    edits = SCRIPT.read_text().splitlines()
    size = figures("info", deck)["parts"][0]["target_size"]
    tell("\nfigure 12 on the sample, one script: demo/whole_way.jsonl")
    found, decks = {}, {0: deck}
    for letter, done, what, options in STAGES:
        if done not in decks:
            decks[done] = out / f"{letter}.k"
            script = out / "script.jsonl"
            script.write_text("\n".join(edits[:done]) + "\n")
            tool("edit", deck, "--script", script, "-o", decks[done])
        found[letter] = of = counts(decks[done], size)
        label = f"({letter})" if len(letter) == 1 else "   "
        if letter == "c":
            tell(f"  (c) {what}: " + ", ".join(f"{count} {kind}" for kind, count in sorted(of["kinds"].items(), key=lambda each: -each[1])))
        else:
            crossing = "no part crosses another" if of["cross"] == 0 else f"parts cross at {of['cross']} place{'s' * (of['cross'] > 1)}"
            tell(f"  {label} {what}: {of['warn']} warn, {of['fail']} fail; {crossing}; {of['welds']} welds, {of['faults'] or 'none'} faulty")
        if with_pictures:
            against = ["--against", deck] if "distance-to-original" in options else []
            tool("render", decks[done], "-o", out / f"{letter}.png", "--profile", "mono", "--size", "1600x1000", *options, *against)
    before = found["a"]
    if not (found["b"]["warn"] + found["b"]["fail"] > before["warn"] + before["fail"] >= found["d"]["warn"] + found["d"]["fail"]):
        raise Stop(f"stretching and repairing gave {found['b']} and {found['d']}, from {before}")
    if not found["pushed"]["cross"] > before["cross"] >= found["e"]["cross"] or found["f"]["faults"] > 0 or found["f"]["welds"] <= before["welds"]:
        raise Stop(f"parts still cross, or the welds aren't as they should be: {found['e']}, {found['f']}")
    difference = figures("diff", deck, decks[STAGES[-1][1]])
    tell(f"  compared: {difference['nodes_moved']} nodes moved, by {difference['max_displacement']:.1f} mm at most; {difference['elements_added']} elements and"
         f" {difference['nodes_added']} nodes more; {difference['lines_changed']} lines of the deck changed")  # fmt: skip
    tell(f"  {shown(out)}: the decks{' and a picture of each' if with_pictures else ''}")
    return found
