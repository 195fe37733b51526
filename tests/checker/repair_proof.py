#!/usr/bin/env python3
"""Strong edits on real decks, then a repair, checked independently: decks are read by the checker's readers, never by the program's.

    repair_proof.py --prismesh PROGRAM [--models FOLDER] [--extreme] [--target-size SIZE] [--only TEXT] [DECK ..]      a table as in docs/repairing.md; status 1 if anything is wrong

For each deck: half of its largest part (by shells) is lifted, and stretched (edits_of); of some decks a free end is pulled away (pulls_of). The deck is written shaped, and written shaped and repaired. Then
- the text: every line that no edit had to touch is the same, sets and ids are right (edit_proof.py);
- the mesh: every edge has as many shells as before or is divided as a whole, no shell names a node twice, none is folded;
- the damage: elements that fail or warn after the lift and didn't before, as the program says, and the shells whose corner angles or edge ratio are
  bad by this file's own count, before and after;
- triangles, pairs of triangles with an edge in common where there were none, and how far nodes are off the shaped surface. A new pair may only be where
  the quad of its two triangles would fail (fails_as_quad), and the edit has to tell of all new pairs.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import check_deck  # noqa: E402
import edit_proof  # noqa: E402
from deck_text import cross, dot, minus, unit  # noqa: E402

DECKS = ["bumper_beam_rad", "seat_adyrel_rad", "simplecar_nas", "hatprofile", "wheel_k", "joint_screw"]
MOST_WRONG = 5
# Parts whose free end is pulled along x: {deck: (parts, length that stretches, amounts)}.
PULLS = {"bumper_beam_rad": ({"4", "5"}, 87, (20, 40, 60, 80))}


def main_file(folder):
    names = sorted(os.listdir(folder))
    return os.path.join(folder, max(names, key=lambda n: os.path.getsize(os.path.join(folder, n))))


def length(a):
    return math.sqrt(dot(a, a))


class Mesh:
    """The shells of a deck with three or four corners."""

    def __init__(self, deck):
        self.at = {id: node.basic() for id, node in deck.nodes.items()}
        self.shells, self.parts, self.broken = {}, {}, 0
        for e in deck.elements:
            if e.cls not in edit_proof.SHELL_CLASSES:
                continue
            corners = [n for n in e.nodes[:4] if n]
            if len(corners) == 4 and corners[3] == corners[2]:
                corners.pop()
            if any(n not in self.at for n in corners) or len(corners) < 3:
                continue
            self.broken += len(set(corners)) != len(corners)
            self.shells[e.cls, e.id] = corners
            self.parts[e.cls, e.id] = e.part

    def edges(self):
        out = {}
        for id, corners in self.shells.items():
            for i, a in enumerate(corners):
                out.setdefault(frozenset((a, corners[i - 1])), []).append(id)
        return out

    def angles(self, id):
        p = [self.at[n] for n in self.shells[id]]
        out = []
        for i in range(len(p)):
            a, b = minus(p[i - 1], p[i]), minus(p[(i + 1) % len(p)], p[i])
            scale = length(a) * length(b)
            out.append(math.degrees(math.acos(max(-1.0, min(1.0, dot(a, b) / scale)))) if scale else 0.0)
        return out

    def is_bad(self, id):
        """Whether a shell is bad by its angles and edge ratio alone."""
        corners, angles = self.shells[id], self.angles(id)
        p = [self.at[n] for n in corners]
        sides = [length(minus(p[i], p[i - 1])) for i in range(len(p))]
        low, high = (20, 120) if len(p) == 3 else (45, 135)
        return min(angles) < low or max(angles) > high or min(sides) <= 0 or max(sides) / min(sides) > 5

    def triangle_pairs(self):
        return {e for e, shells in self.edges().items() if len([s for s in shells if len(self.shells[s]) == 3]) > 1}

    def normal(self, id):
        c = self.shells[id]
        p = [self.at[n] for n in c]
        return cross(minus(p[1 if len(p) == 3 else 2], p[0]), minus(p[2 if len(p) == 3 else 3], p[0 if len(p) == 3 else 1]))

    def between_creases(self, min_length, smallest_angle=46, crease=30):
        """Quads with a side shorter than `min_length` across a row between two creases: how many, and how many of them lie where the row is
        so narrow that no quad between the creases can be longer: its side would lean by more than its smallest angle allows."""
        edges = self.edges()

        def is_crease(a, b):
            shells = edges[frozenset((a, b))]
            if len(shells) != 2:
                return True
            one, other = (self.normal(s) for s in shells)
            size = length(one) * length(other)
            # Shells on both sides of an edge that pass it the same way have opposite normals.
            same_way = [(a, b) in list(zip(self.shells[s][-1:] + self.shells[s][:-1], self.shells[s])) for s in shells]
            cos = dot(one, other) / size * (-1 if same_way[0] == same_way[1] else 1) if size else 1
            return cos < math.cos(math.radians(crease))
        short = narrow = 0
        for id, c in self.shells.items():
            if len(c) != 4:
                continue
            for k in (0, 1):
                a, b, d, e = c[k:] + c[:k]  # a-b and d-e across, b-d and e-a along
                p = [self.at[n] for n in (a, b, d, e)]
                if min(length(minus(p[1], p[0])), length(minus(p[2], p[3]))) >= min_length or not (is_crease(b, d) and is_crease(e, a)):
                    continue
                short += 1
                widths = [point_to_line(p[0], p[1], p[2]), point_to_line(p[3], p[1], p[2]), point_to_line(p[1], p[0], p[3]), point_to_line(p[2], p[0], p[3])]
                narrow += min(widths) < min_length * math.sin(math.radians(smallest_angle))
        return short, narrow

    def needs_pair(self, edge, shells, size):
        """Whether the quad of two triangles with a common edge fails."""
        a, b = edge
        first, second = (self.shells[s] for s in shells)
        tip = [next(n for n in c if n not in edge) for c in (first, second)]
        p = [self.at[n] for n in (a, tip[0], b, tip[1])]
        if len(set((a, b, *tip))) < 4:
            return True
        corner = [(minus(p[i - 1], p[i]), minus(p[(i + 1) % 4], p[i])) for i in range(4)]
        normal = cross(minus(p[2], p[0]), minus(p[3], p[1]))
        if any(dot(cross(out, back), normal) <= 0 for back, out in corner):
            return True  # a corner points inwards
        angles = [math.degrees(math.acos(max(-1.0, min(1.0, dot(u, v) / (length(u) * length(v)))))) for u, v in corner]
        return fails_as_quad(p, angles, size)

    def facets(self):
        for id, c in self.shells.items():
            p = [self.at[n] for n in c]
            yield p[0], p[1], p[2]
            if len(p) == 4:
                yield p[0], p[2], p[3]


def point_to_line(p, a, b):
    along = minus(b, a)
    return length(cross(along, minus(p, a))) / length(along) if length(along) else length(minus(p, a))


def point_to_triangle(p, a, b, c):
    """Distance, by the regions of the plane around the triangle."""
    ab, ac, ap = minus(b, a), minus(c, a), minus(p, a)
    d1, d2 = dot(ab, ap), dot(ac, ap)
    if d1 <= 0 and d2 <= 0:
        return length(ap)
    bp = minus(p, b)
    d3, d4 = dot(ab, bp), dot(ac, bp)
    if d3 >= 0 and d4 <= d3:
        return length(bp)
    cp = minus(p, c)
    d5, d6 = dot(ab, cp), dot(ac, cp)
    if d6 >= 0 and d5 <= d6:
        return length(cp)

    def along(from_, way, t):
        return length(minus(p, tuple(f + t * w for f, w in zip(from_, way))))
    vc = d1 * d4 - d3 * d2
    if vc <= 0 <= d1 and d3 <= 0:
        return along(a, ab, d1 / (d1 - d3))
    vb = d5 * d2 - d1 * d6
    if vb <= 0 <= d2 and d6 <= 0:
        return along(a, ac, d2 / (d2 - d6))
    va = d3 * d6 - d5 * d4
    if va <= 0 and d4 >= d3 and d5 >= d6:
        return along(b, minus(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6)))
    n = cross(ab, ac)
    return abs(dot(unit(n), ap)) if length(n) > 0 else length(ap)


def bend(p, i):
    """The angle between the halves of a quad that corners i and i + 2 part."""
    a, b, c, d = (p[(i + k) % 4] for k in range(4))
    one, other = cross(minus(b, a), minus(c, a)), cross(minus(c, a), minus(d, a))
    scale = length(one) * length(other)
    return math.degrees(math.acos(max(-1.0, min(1.0, dot(one, other) / scale)))) if scale else 180.0


def jacobian_ratio(p):
    """Smallest by largest determinant at the 2 x 2 Gauss points."""
    g = 1 / math.sqrt(3)
    middle = unit(cross(minus(p[2], p[0]), minus(p[3], p[1])))
    values = []
    for s, t in ((-g, -g), (g, -g), (g, g), (-g, g)):
        by_s = [((1 - t) * (p[1][k] - p[0][k]) + (1 + t) * (p[2][k] - p[3][k])) / 4 for k in range(3)]
        by_t = [((1 - s) * (p[3][k] - p[0][k]) + (1 + s) * (p[2][k] - p[1][k])) / 4 for k in range(3)]
        values.append(dot(cross(by_s, by_t), middle))
    return min(values) / max(values) if max(values) > 0 else -1.0


def fails_as_quad(p, angles, size):
    """Whether a quad fails by the built-in criteria, as this file computes them; those that are near to failing count too, since a repair keeps away from
    the limits by a thousandth."""
    sides = [length(minus(p[i], p[i - 1])) for i in range(4)]
    middles = [tuple((p[i][k] + p[i - 1][k]) / 2 for k in range(3)) for i in range(4)]
    one, other = minus(middles[0], middles[2]), minus(middles[1], middles[3])
    scale = length(one) * length(other)
    skew = 90 - math.degrees(math.acos(min(1.0, abs(dot(one, other)) / scale))) if scale else 90.0
    corners = [length(cross(minus(p[i - 1], p[i]), minus(p[(i + 1) % 4], p[i]))) / 2 for i in range(4)]
    area = length(cross(minus(p[2], p[0]), minus(p[3], p[1]))) / 2
    taper = 1 - min(corners) / (area / 2) if area else 1.0
    k = 0.999
    return (max(bend(p, 0), bend(p, 1)) > 15 * k or min(angles) < 40 / k or max(angles) > 140 * k or min(sides) < 0.2 * size / k
            or max(sides) > 2 * size * k or max(sides) > 5 * k * min(sides) or skew > 40 * k or taper > 0.6 * k or jacobian_ratio(p) < 0.6 / k)


class Grid:
    def __init__(self, mesh, size):
        self.size, self.cells = size, {}
        for facet in mesh.facets():
            low = [min(p[k] for p in facet) for k in range(3)]
            high = [max(p[k] for p in facet) for k in range(3)]
            ranges = [range(math.floor((low[k] - size / 4) / size), math.floor((high[k] + size / 4) / size) + 1) for k in range(3)]
            if len(ranges[0]) * len(ranges[1]) * len(ranges[2]) > 4000:
                continue
            for x in ranges[0]:
                for y in ranges[1]:
                    for z in ranges[2]:
                        self.cells.setdefault((x, y, z), []).append(facet)

    def distance(self, p):
        near = self.cells.get(tuple(math.floor(c / self.size) for c in p), [])
        return min((point_to_triangle(p, *facet) for facet in near), default=math.inf)


def target_part(mesh):
    count = {}
    for part in mesh.parts.values():
        count[part] = count.get(part, 0) + 1
    return max(count, key=lambda part: (count[part], str(part)))


def target_size_of(mesh):
    """The median edge of the part that is shaped: the deck's own may be that of quite other parts."""
    part = target_part(mesh)
    lengths = sorted(math.sqrt(distance2(mesh.at[c[i]], mesh.at[c[i - 1]]))
                     for id, c in mesh.shells.items() if mesh.parts[id] == part for i in range(len(c)))
    return float(f"{lengths[len(lengths) // 2]:.4g}")


def distance2(a, b):
    d = minus(a, b)
    return dot(d, d)


def edits_of(mesh, extreme):
    """{name: edit} that shape half of the largest part, along its longest extent.

    lift: a dome in the widest place, its free edges held, as high as that is away from the border: 45 degrees on average, 56 where it is steepest;
    lower by steps of a fifth as long as anything is folded over.
    stretch: everything beyond the part's middle is drawn away by a quarter of the part's length; what it hangs on stretches by half on average.
    extreme: the lift by 15 % however near the border is, and a push: a point in the sheet goes along it by a quarter of the part's length, which
    folds what lies before it where that is narrow."""
    part = target_part(mesh)
    nodes = {n for id, corners in mesh.shells.items() if mesh.parts[id] == part for n in corners}
    low = [min(mesh.at[n][k] for n in nodes) for k in range(3)]
    high = [max(mesh.at[n][k] for n in nodes) for k in range(3)]
    axis = max(range(3), key=lambda k: high[k] - low[k])
    long = high[axis] - low[axis]
    middle = sorted(mesh.at[n][axis] for n in nodes)[len(nodes) // 2]
    half = {n for n in nodes if mesh.at[n][axis] >= middle}
    beyond = {n for n in mesh.at if mesh.at[n][axis] >= middle}

    def along(amount):
        return [amount if k == axis else 0.0 for k in range(3)]

    def on(chosen):
        return ",".join(map(str, sorted(chosen)))
    push = {"edit": "translate", "by": along(0.25 * long), "on": on(half)}
    if extreme:
        return {"extreme lift": {"edit": "lift", "distance": 0.15 * long, "on": on(half)}, "push": push}
    free = {n for e, shells in mesh.edges().items() if len(shells) == 1 for n in e}
    border = {n for corners in mesh.shells.values() if not half.issuperset(corners) for n in corners if n in half} | (free & half)
    away = {n: min(distance2(mesh.at[n], mesh.at[b]) for b in border) for n in half}
    grab = max(sorted(away), key=lambda n: away[n])
    end = max(sorted(nodes - free), key=lambda n: mesh.at[n][axis])
    return {"lift": {"edit": "lift", "distance": math.sqrt(away[grab]), "grab": grab, "free_ends": False, "on": on(half)},
            "stretch": {"edit": "translate", "by": along(0.25 * long), "grab": end, "on": on(beyond),
                        "falloff": {"profile": "smooth", "along": along(1.0)}}}


def pulls_of(mesh, name):
    """{name: edit} that pull the free end of some parts away; what is within the given length of the end stretches, evenly or smoothly."""
    if name not in PULLS:
        return {}
    parts, over, amounts = PULLS[name]
    nodes = {n for id, corners in mesh.shells.items() if str(mesh.parts[id]) in parts for n in corners}
    end = max(mesh.at[n][0] for n in nodes)
    on = sorted(n for n in nodes if mesh.at[n][0] >= end - over)
    grab = max(on, key=lambda n: mesh.at[n][0])
    return {f"pull {amount} {profile}": {"edit": "translate", "by": [amount, 0, 0], "grab": grab, "on": ",".join(map(str, on)), "across_welds": True,
                                         "falloff": {"profile": profile, "along": [1, 0, 0]}}
            for profile in ("linear", "smooth") for amount in amounts}


def check_mesh(before, after, wrong):
    if after.broken > before.broken:
        wrong.append(f"{after.broken - before.broken} shells name a node twice")
    old, new = before.edges(), after.edges()
    # A hanging node is a free edge where there was none: such edges may only lie on old free edges' nodes or between new nodes on them.
    free_before = {n for e, shells in old.items() if len(shells) == 1 for n in e}
    for e, shells in new.items():
        if len(shells) == 1 and e not in old and not any(n in free_before or n not in before.at for n in e):
            wrong.append(f"the edge {sorted(e)} of shell {shells[0]} has become free")
    # Where sheets meet edges may be divided with all their shells; so the lines are as long as they were, between the same parts.
    junctions = [junction_lengths(mesh, edges) for mesh, edges in ((before, old), (after, new))]
    for parts in set(junctions[0]) | set(junctions[1]):
        lengths = [j.get(parts, 0.0) for j in junctions]
        if abs(lengths[1] - lengths[0]) > 0.02 * max(lengths):
            wrong.append(f"the edges of {len(parts)} shells of the parts {sorted(set(parts))} were {lengths[0]:g} long and are {lengths[1]:g}")


def junction_lengths(mesh, edges):
    """{the parts of the shells at an edge of three and more: the length of all such edges}"""
    lengths = {}
    for nodes, shells in edges.items():
        if len(shells) > 2 and len(nodes) == 2:
            a, b = nodes
            parts = tuple(sorted(str(mesh.parts[s]) for s in shells))
            lengths[parts] = lengths.get(parts, 0.0) + math.sqrt(distance2(mesh.at[a], mesh.at[b]))
    return lengths


def run(prismesh, deck, target_size, edits, out):
    arguments = [a for e in edits for a in ("--edit", json.dumps(e))]
    done = subprocess.run([prismesh, "edit", deck, "--target-size", str(target_size), *arguments, "-o", out, "--json"],
                          capture_output=True, text=True)
    told = [json.loads(line) for line in done.stdout.splitlines()]
    if done.returncode:
        raise RuntimeError(done.stderr.strip()[-400:])
    return told


def counts(prismesh, deck, target_size):
    done = subprocess.run([prismesh, "check", deck, "--json", "--target-size", str(target_size)], capture_output=True, text=True)
    told = json.loads(done.stdout)
    return {"warn": told["warn"], "fail": told["fail"]}


def without_folds(prismesh, main, target_size, edit, folder):
    """The edit, less strong if elements turn over: no repair of a mesh unfolds a sheet."""
    out = os.path.join(folder, "try_" + os.path.basename(main))
    while "distance" in edit and run(prismesh, main, target_size, [edit], out)[-1]["inverted"] > 0:
        edit = edit | {"distance": 0.8 * edit["distance"]}
    return edit


def prove(prismesh, main, name, kind, edit, original, before, target_size, folder):
    wrong = []
    shaped_path, repaired_path = (os.path.join(folder, f"{k}_" + os.path.basename(main)) for k in ("shaped", "repaired"))
    shaping = run(prismesh, main, target_size, [edit], shaped_path)[-1]
    told = run(prismesh, main, target_size, [edit, {"edit": "repair"}], repaired_path)[-1]
    shaped, repaired_deck = Mesh(check_deck.read(shaped_path)), check_deck.read(repaired_path)
    repaired = Mesh(repaired_deck)
    proof = edit_proof.compare(original, repaired_deck, {"moved_freely": True, "nodes_added": "any", "elements_added": "any",
                                                         "elements_removed": "any", "elements_changed": "any"})
    wrong += proof["wrong"]
    check_mesh(shaped, repaired, wrong)
    found = len(repaired.shells) - len(shaped.shells)
    if found != told["elements_added"] - told["elements_removed"]:
        wrong.append(f"{found} shells more, not {told['elements_added']} - {told['elements_removed']}")
    again = counts(prismesh, repaired_path, target_size)
    if again != told["after"]:
        wrong.append(f"reopened it has {again}, the edit said {told['after']}")
    edges, pairs_before = repaired.edges(), shaped.triangle_pairs()
    new_pairs = [e for e in repaired.triangle_pairs() if e not in pairs_before]
    for e in new_pairs:
        if len(edges[e]) == 2 and not repaired.needs_pair(e, edges[e], target_size):
            wrong.append(f"the triangles {edges[e][0][1]} and {edges[e][1][1]} would be a good quad")
    if len(new_pairs) != told["triangle_pairs"]:
        wrong.append(f"there are {len(new_pairs)} new pairs of triangles, the edit said {told['triangle_pairs']}")
    grid = Grid(shaped, 2 * target_size)
    touched = [n for n, at in repaired.at.items() if shaped.at.get(n) != at]
    off = max((grid.distance(repaired.at[n]) for n in touched), default=0.0)
    bad = {kind: sum(mesh.is_bad(id) for id in mesh.shells) for kind, mesh in (("before", before), ("shaped", shaped), ("after", repaired))}
    triangles = [100 * sum(len(c) == 3 for c in m.shells.values()) / len(m.shells) for m in (before, repaired)]
    pairs = len(repaired.triangle_pairs()) - len(before.triangle_pairs())
    damage = [told["before"][k] - shaping["before"][k] for k in ("fail", "warn")], [told["after"][k] - shaping["before"][k] for k in ("fail", "warn")]
    short, narrow = repaired.between_creases(0.4 * target_size)
    print(f"| {name} | {kind} | {damage[0][0]} / {damage[0][1]} | {damage[1][0]} / {damage[1][1]} | "
          f"{bad['shaped'] - bad['before']} → {bad['after'] - bad['before']} | {triangles[0]:.1f} → {triangles[1]:.1f} | {pairs} | "
          f"{100 * off / target_size:.1f} | {short} / {narrow} | {told['ms'] / 1000:.1f} | {'yes' if not wrong else 'NO'} |", flush=True)
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--prismesh", required=True)
    parser.add_argument("--models", default=os.environ.get("PRISMESH_MODELS", ""))
    parser.add_argument("--extreme", action="store_true", help="stronger than anything sensible")
    parser.add_argument("--target-size", type=float, help="in place of the median edge of the part that is shaped")
    parser.add_argument("--only", default="", help="only edits whose names hold this")
    parser.add_argument("decks", nargs="*", default=DECKS)
    options = parser.parse_args()
    if not os.path.isdir(options.models):
        print("no folder of real decks: give --models or set PRISMESH_MODELS", file=sys.stderr)
        return 77
    print("| deck | edit | damage: fail / warn more than before | after repair | bad by angles and edge ratio | triangles % | new triangle pairs | "
          "off the shaped surface, % of element size | short between creases / row too narrow | s | proved |\n|---|---|---|---|---|---|---|---|---|---|---|")
    failed = 0
    for name in options.decks:
        path = main_file(os.path.join(options.models, name))
        deck = check_deck.read(path)
        before = Mesh(deck)
        size = options.target_size or target_size_of(before)
        for kind, edit in (edits_of(before, options.extreme) | ({} if options.extreme else pulls_of(before, name))).items():
            if options.only not in kind:
                continue
            with tempfile.TemporaryDirectory(prefix="prismesh-repair-") as folder:
                try:
                    if not options.extreme:
                        edit = without_folds(options.prismesh, path, size, edit, folder)
                    wrong = prove(options.prismesh, path, name, kind, edit, deck, before, size, folder)
                except (RuntimeError, subprocess.SubprocessError) as error:
                    wrong = [str(error)]
                for sentence in wrong[:MOST_WRONG]:
                    print(f"{name}: {sentence}", file=sys.stderr)
                failed += bool(wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
