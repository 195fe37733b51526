#!/usr/bin/env python3
"""Every real deck that PRISMESH_MODELS points to: what the program reads, saves and edits, against the independent checker.

    real_decks.py PRISMESH [--grow GROW_DECK] [DECK..]       PRISMESH: the program; DECK: names in counts.json, all without

For each deck: `info --json` has the checker's counts, and those of counts.json where they are right; `edit` without edits gives the same
bytes, includes too; a node, a part and everything moved change exactly the cards that had to change, by the right amount. GROW_DECK (of
grow_deck.cpp) divides edges and removes shells: new cards stand in the sets they must be in, under ids of their own.
Exit status 77 where there are no models: the test is skipped.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import check_deck  # noqa: E402
import edit_proof  # noqa: E402

# Where counts.json and the decks differ, and why the decks are right. {deck: {what: (counts.json, the deck)}}
EXCEPTIONS = {
    # *INCLUDE_PATH_RELATIVE submodels leads to material_props.k; only missing_geometry.k is missing.
    "bolt_a_missing_include": {"missing_includes": (["material_props.k", "missing_geometry.k"], ["missing_geometry.k"])},
    # The file has *BEAM SECTION and *FLUID SECTION beside *SHELL SECTION; the counter knows shell sections alone.
    "ccx_furnace": {"parts_defined": (1, 2)},
    "ccx_wire": {"parts_defined": (1, 2), "parts_with_elements": (1, 2)},
    # Elements of no set and no section: no part by the checker's rules, one by the counter's.
    "jp_model_inp": {"parts_with_elements": (1, 0)},
    # Beams without a third node: blank fields name no node. The counter looks at two nodes of a beam, the checker at three.
    "pydyna_expand_include": {"missing_node_references": (8, 12)},
    # Its "node that is not there" is the number 0 in an empty field.
    "pydyna_transform_8node_shells": {"missing_node_references": (1, 0)},
    # The counter takes an RBE2's or CONM2's first grid point for a property.
    "aero2728_dfem": {"parts_with_elements": (129, 95)},
    "isat_launch": {"parts_with_elements": (91, 33)},
    "wingbox_stitched": {"parts_with_elements": (6, 5)},
    # The same; and PBARL and PBEAML between tabs aren't seen by the counter. PLOTEL3 and PLOTEL4 it doesn't know.
    "bwb_saero": {"parts_with_elements": (220, 63), "parts_defined": (64, 67)},
    # The counter knows neither PDAMP, PVISC, PMASS, PBEND, PLPLANE, PLSOLID, PBUSH1D nor cards whose fields blanks separate (PSHEAR).
    "cqra00366": {"parts_with_elements": (55, 49), "parts_defined": (33, 54)},
    "d200obus": {"parts_with_elements": (31, 25), "parts_defined": (20, 28)},
    # A 1970s deck: PQUAD1 is a property, though one that today's solvers don't know.
    "nastran95_d08012a": {"parts_defined": (0, 1)},
}
# Refused decks, and the words that the error must contain.
REFUSED = {"nastran95_d08012a": "CQUAD1"}
# No node to move: a fragment, or nothing but parameters.
WITHOUT_NODES = {"pydyna_expand_include", "pydyna_param_scopes"}

SHELLS = {"shell", "sh3n"}
CORNERS = {"S6": 3, "S8": 4, "S8R": 4, "S8R5": 4, "STRI65": 3, "CQUAD8": 4, "CTRIA6": 3, "CQUAD": 4, "SHELL_QUAD_8n": 4, "SHELL_TRI_6n": 3}


class Failures:
    def __init__(self):
        self.sentences = []

    def expect(self, right, sentence):
        if not right:
            self.sentences.append(sentence)


class Program:
    """Runs prismesh and keeps the processor time it took."""

    def __init__(self, path):
        self.path = path

    def __call__(self, *arguments):
        done = subprocess.run([self.path, *arguments], capture_output=True, text=True, errors="replace")
        return done.returncode, done.stdout, done.stderr


def check_counts(told, deck, counter, name, failures):
    """told: of info --json; deck: the checker's; counter: of counts.json."""
    format = told["format"]
    mine = check_deck.counts(deck, format)
    for what in ("nodes", "parts_defined", "parts_with_elements", "missing_includes", "missing_node_references", "crlf_lines"):
        theirs, wanted = EXCEPTIONS.get(name, {}).get(what, (counter[what], counter[what]))
        failures.expect(counter[what] == theirs, f"counts.json says {what} = {counter[what]}, no longer {theirs}: look again")
        failures.expect(mine[what] == wanted, f"the checker counts {what} = {mine[what]}, not {wanted}")
    for word, count in counter["elements"].items():
        failures.expect(mine["elements"].get(word, 0) == count, f"the checker counts {mine['elements'].get(word, 0)} {word}, not {count}")
    failures.expect(told["nodes"] == mine["nodes"], f"info says {told['nodes']} nodes, the checker {mine['nodes']}")
    check_classes({k: told["elements"][k] + told["elements_left_out"][k] for k in told["elements"]}, deck, failures)
    check_left_out(told, deck, failures)
    ids = {p["id"] for p in told["parts"]}
    wanted = {p for p in deck.parts | {e.part for e in deck.elements if e.cls in SHELLS and e.part} if isinstance(p, int)}
    failures.expect(wanted <= ids, f"info doesn't tell of parts {sorted(wanted - ids)[:5]}")
    shells = sum(p["quads"] + p["tris"] for p in told["parts"])
    failures.expect(shells <= sum(told["elements"][k] for k in ("quad", "tri", "quad8", "tri6")), f"the parts have {shells} shells")


# What info calls the kinds of elements; what stands nowhere is "other" or no element for info, and both is said to be right.
CLASSES = {
    "quad": "SHELL_QUAD CQUAD4 CQUADR SHELL S4 S4R S4R5 S4RS".split(),
    "tri": "SHELL_TRI CTRIA3 CTRIAR SH3N S3 S3R STRI3".split(),
    "quad8": "SHELL_QUAD_8n CQUAD8 CQUAD S8 S8R S8R5".split(),
    "tri6": "SHELL_TRI_6n CTRIA6 S6 STRI65".split(),
    "beam": "BEAM CBAR CBEAM CROD CONROD CTUBE CBEND TRUSS B31 B32 B31R B32R".split(),
    "solid": "SOLID_HEX SOLID_PENTA SOLID_TET SOLID_PYRAMID CHEXA CPENTA CTETRA BRICK TETRA4 TETRA10 PENTA6 C3D8 C3D4 C3D8R C3D6".split(),
    "tshell": ["TSHELL"],
}


def check_classes(told, deck, failures):
    for cls, words in CLASSES.items():
        mine = sum(deck.words.get(w, 0) for w in words)
        failures.expect(told[cls] == mine, f"info says {told[cls]} {cls}, the checker {mine}")


def check_left_out(told, deck, failures):
    """Shells that name a node which nobody defines, or that have too few, aren't in the model; nor is a second one of the same id."""
    kinds = {word for cls in ("quad", "tri", "quad8", "tri6") for word in CLASSES[cls]}
    whole, ids = 0, set()
    for e in deck.elements:
        if e.kind in kinds and len([n for n in e.nodes if n]) >= 3 and all(n in deck.nodes for n in e.nodes if n) and e.id not in ids:
            whole += 1
            ids.add(e.id)
    shown = sum(told["elements"][k] for k in ("quad", "tri", "quad8", "tri6"))
    failures.expect(shown == whole, f"info counts {shown} shells that are not left out, the checker {whole}")


def same_files(deck, folder, failures):
    for f in deck.files:
        try:
            with open(os.path.join(folder, f.relative), "rb") as saved:
                failures.expect(saved.read() == f.data, f"{f.relative} isn't the same bytes after saving without edits")
        except OSError as error:
            failures.expect(False, f"{f.relative} wasn't saved: {error}")


def edit(prismesh, main, folder, edits):
    out = os.path.join(folder, os.path.basename(main))
    arguments = [a for e in edits for a in ("--edit", json.dumps(e))]
    status, told, said = prismesh("edit", main, *arguments, "-o", out, "--json")
    return status, told, said, out


def mid_side_moves(deck, moved, by):
    """Mid-side nodes go half the way of each end of their edge."""
    out = {id: tuple(by) for id in moved}
    for e in deck.elements:
        n = CORNERS.get(e.kind)
        if not n:
            continue
        for i in range(n):
            mid = e.nodes[n + i] if n + i < len(e.nodes) else 0
            share = ((e.nodes[i] in moved) + (e.nodes[(i + 1) % n] in moved)) / 2
            if mid and mid not in moved and share:
                out[mid] = tuple(share * d for d in by)
    return out


def try_edit(prismesh, reader, main, deck, edits, expected, what, failures):
    """Does it, and proves it. A refusal counts as proof only if it names its reason with a place. Returns what was found, or None."""
    with tempfile.TemporaryDirectory(prefix="prismesh-check-") as folder:
        status, told, said, out = edit(prismesh, main, folder, edits)
        if status:
            failures.expect(":" in said and not os.listdir(folder), f"{what}: refused without a reason: {said[:200]}")
            return said
        after = reader(out)
        report = edit_proof.compare(deck, after, expected)
        for sentence in report["wrong"]:
            failures.expect(False, f"{what}: {sentence}")
        moved = [json.loads(line) for line in told.splitlines()][-1]["nodes_moved"]
        failures.expect(moved >= report["found"]["nodes_moved"], f"{what}: says {moved} moved, {report['found']['nodes_moved']} differ")
        return report["found"]


def check_edits(prismesh, reader, main, deck, name, failures):
    ids = [id for id in deck.nodes]
    if not ids:
        failures.expect(name in WITHOUT_NODES, "has no nodes")
        return "no nodes"
    size = max(math.dist(deck.nodes[ids[0]].basic(), deck.nodes[id].basic()) for id in ids[:: max(1, len(ids) // 100)]) or 1.0
    by = [round(size * f, 6) for f in (0.0137, -0.0211, 0.0173)]
    told = []
    corners = {n for e in deck.elements if e.kind in CORNERS for n in e.nodes[:CORNERS[e.kind]]}
    mids = {n for e in deck.elements if e.kind in CORNERS for n in e.nodes[CORNERS[e.kind]:]}
    one = next((id for id in ids[len(ids) // 2:] if id not in mids or id in corners), ids[-1])
    found = try_edit(prismesh, reader, main, deck,
                     [{"edit": "select", "expr": str(one)}, {"edit": "translate", "by": by, "falloff": {"profile": "constant"}}],
                     {"moved_by_node": mid_side_moves(deck, {one}, by)}, f"node {one}", failures)
    told.append(found)
    part = next((e.part for e in deck.elements if e.cls in SHELLS and e.part and isinstance(e.part, int)), None)
    if part is not None:
        of_part = {n for e in deck.elements if e.part == part for n in e.nodes if n in deck.nodes}
        on = {"edit": "select", "expr": f"part:{part}"}
        told.append(try_edit(prismesh, reader, main, deck,
                             [{"edit": "translate", "by": by, "on": on, "falloff": {"profile": "constant"}}],
                             {"moved": {"by": by, "nodes": sorted(of_part)}, "rim_may_stay": True}, f"part {part}", failures))
    told.append(try_edit(prismesh, reader, main, deck,
                         [{"edit": "select", "expr": "all"}, {"edit": "translate", "by": by, "falloff": {"profile": "constant"}}],
                         {"moved": {"by": by, "nodes": "all"}}, "all", failures))
    return told


def check_growth(grow, reader, main, deck, failures):
    """Returns what was done, or the refusal."""
    with tempfile.TemporaryDirectory(prefix="prismesh-check-") as folder:
        out = os.path.join(folder, os.path.basename(main))
        status, told, said = grow(main, out, "20", "3")
        if status:
            failures.expect(status == 1 and ":" in said, f"growing: {said[:200]}")
            return "not grown: " + said.strip()
        told = json.loads(told)
        expected = {k: told[k] for k in ("nodes_added", "elements_added", "elements_changed", "elements_removed")}
        for sentence in edit_proof.compare(deck, reader(out), expected)["wrong"]:
            failures.expect(False, f"growing: {sentence}")
        return told


def check(prismesh, grow, models, name, counter):
    failures = Failures()
    main = os.path.join(models, counter["main"])
    format = {"lsdyna": "ls-dyna"}.get(counter["format"], counter["format"])
    failures.expect(check_deck.format_of(main) == format, f"the checker takes it for {check_deck.format_of(main)}")
    reader = check_deck.READERS[format]
    deck = reader(main)
    status, told, said = prismesh("info", main, "--json")
    if name in REFUSED:
        failures.expect(status == 1 and REFUSED[name] in said, f"should be refused for its {REFUSED[name]}, not: {said[:200]}")
        return failures, "refused: " + said.strip()
    if status:
        failures.expect(False, f"isn't opened: {said.strip()[:300]}")
        return failures, ""
    told = json.loads(told)
    failures.expect(told["format"] == format, f"is {told['format']}")
    check_counts(told, deck, counter, name, failures)
    with tempfile.TemporaryDirectory(prefix="prismesh-check-") as folder:
        status, _, said, _ = edit(prismesh, main, folder, [])
        failures.expect(status == 0, f"isn't saved: {said[:300]}")
        if status == 0:
            same_files(deck, folder, failures)
    found = check_edits(prismesh, reader, main, deck, name, failures)
    if grow and any(e.cls in SHELLS | {"element"} for e in deck.elements):
        found = [found, check_growth(grow, reader, main, deck, failures)]
    return failures, found


def main(arguments):
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    models = os.environ.get("PRISMESH_MODELS", "")
    if not os.path.exists(os.path.join(models, "counts.json")):
        print("PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED")
        return 77
    with open(os.path.join(models, "counts.json")) as f:
        counters = json.load(f)
    program, rest, grow = Program(arguments[0]), arguments[1:], None
    if rest[:1] == ["--grow"]:
        grow, rest = Program(rest[1]), rest[2:]
    wanted = rest or list(counters)
    bad, start = 0, time.process_time()
    for name in wanted:
        began = time.monotonic()
        failures, found = check(program, grow, models, name, counters[name])
        print(f"{'ok  ' if not failures.sentences else 'BAD '} {name}  {time.monotonic() - began:.1f} s")
        if rest:
            print("    ", found)
        for sentence in failures.sentences:
            print("    " + sentence)
        sys.stdout.flush()
        bad += bool(failures.sentences)
    children = os.times()
    print(f"{len(wanted) - bad} of {len(wanted)} decks are right; {time.process_time() - start:.0f} s of checking, "
          f"{children.children_user + children.children_system:.0f} s of prismesh")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
