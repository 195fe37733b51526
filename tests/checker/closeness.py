#!/usr/bin/env python3
"""Which shells are too close, and how deep, against the program: closeness.py CLOSE_SHELLS

All pairs of random sheets on a grid of 1/1024, by exact squares of distances: corner to corner, side and face, side to side, and whether a side
passes through a face. The rules for neighbours are computed from the page docs/contact.md. Pairs within 1e-9 of a rule's border aren't compared.
"""
import heapq
import math
import random
import subprocess
import sys
from fractions import Fraction

GRID = 1024
MARGIN = 1e-9


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def corner_side(p, a, b):
    """The square of the distance of a point from the inside of a side, and where; None where its foot is outside."""
    u, w = sub(b, a), sub(p, a)
    uu, uw = dot(u, u), dot(u, w)
    if uu == 0 or not 0 <= uw <= uu:
        return None
    share = uw / uu
    return Fraction(dot(w, w) * uu - uw * uw, uu), [x + share * y for x, y in zip(a, u)]


def corner_face(p, t, n, nn):
    if any(dot(cross(sub(t[(i + 1) % 3], t[i]), sub(p, t[i])), n) < 0 for i in range(3)):
        return None
    height = dot(sub(p, t[0]), n)
    return Fraction(height * height, nn), [x - height / nn * y for x, y in zip(p, n)]


def side_side(a, b, c, d):
    """Where the lines are nearest inside both sides."""
    u, v, w = sub(b, a), sub(d, c), sub(a, c)
    n = cross(u, v)
    nn = dot(n, n)
    if nn == 0:
        return None
    s, t = dot(cross(v, w), n), dot(cross(u, w), n)
    if not (0 <= s <= nn and 0 <= t <= nn):
        return None
    height = dot(w, n)
    return (Fraction(height * height, nn), [x + s / nn * y for x, y in zip(a, u)], [x + t / nn * y for x, y in zip(c, v)])


def passes(p, q, t, n):
    before, after = dot(sub(p, t[0]), n), dot(sub(q, t[0]), n)
    if (before > 0) == (after > 0) or before == after:
        return False
    turns = [dot(cross(sub(q, p), sub(t[i], p)), sub(t[(i + 1) % 3], p)) for i in range(3)]
    return all(x >= 0 for x in turns) or all(x <= 0 for x in turns)


def nearest(a, b):
    """The square of the distance of two triangles, exactly, and the nearest points of both."""
    na, nb = (cross(sub(t[1], t[0]), sub(t[2], t[0])) for t in (a, b))
    best = [None]

    def keep(square, on_a, on_b):
        if best[0] is None or square < best[0][0]:
            best[0] = (square, on_a, on_b)
    for i in range(3):
        if passes(a[i], a[(i + 1) % 3], b, nb) or passes(b[i], b[(i + 1) % 3], a, na):
            return Fraction(0), a[i], a[i]
        for j in range(3):
            w = sub(a[i], b[j])
            keep(Fraction(dot(w, w)), a[i], b[j])
            if found := corner_side(a[i], b[j], b[(j + 1) % 3]):
                keep(found[0], a[i], found[1])
            if found := corner_side(b[j], a[i], a[(i + 1) % 3]):
                keep(found[0], found[1], b[j])
            if found := side_side(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]):
                keep(*found)
        if found := corner_face(a[i], b, nb, dot(nb, nb)):
            keep(found[0], a[i], found[1])
        if found := corner_face(b[i], a, na, dot(na, na)):
            keep(found[0], found[1], b[i])
    return best[0]


class Sheets:
    def __init__(self):
        self.nodes, self.shells, self.thickness = [], [], []

    def add(self, columns, rows, thickness, triangles, place):
        first, stride = len(self.nodes), columns + 1
        for j in range(rows + 1):
            for i in range(columns + 1):
                self.nodes.append(tuple(round(GRID * x) for x in place(i, j)))
        for j in range(rows):
            for i in range(columns):
                a = first + i + j * stride
                quad = (a, a + 1, a + stride + 1, a + stride)
                for shell in [(quad[0], quad[1], quad[2], quad[2]), (quad[0], quad[2], quad[3], quad[3])] if triangles else [quad]:
                    self.shells.append(shell)
                    self.thickness.append(thickness)

    def text(self, gap):
        lines = [f"{len(self.nodes)} {len(self.shells)} {gap!r}"]
        lines += [" ".join(repr(x / GRID) for x in node) for node in self.nodes]
        lines += [" ".join([repr(t)] + [str(n) for n in shell]) for t, shell in zip(self.thickness, self.shells)]
        return "\n".join(lines)

    def triangles(self, shell):
        c = [self.nodes[n] for n in self.shells[shell]]
        found = [(c[0], c[1], c[2])] + ([(c[0], c[2], c[3])] if self.shells[shell][2] != self.shells[shell][3] else [])
        return [t for t in found if cross(sub(t[1], t[0]), sub(t[2], t[0])) != (0, 0, 0)]

    def paths(self, shell):
        """The lengths of the shortest paths over sides and diagonals from a shell's corners to all nodes."""
        links = {}
        for corners in self.shells:
            for n in corners:
                links.setdefault(n, set()).update(set(corners) - {n})
        length = {n: 0.0 for n in self.shells[shell]}
        waiting = [(0.0, n) for n in self.shells[shell]]
        while waiting:
            at, n = heapq.heappop(waiting)
            if at > length[n]:
                continue
            for to in links[n]:
                further = at + math.dist(self.nodes[n], self.nodes[to]) / GRID
                if further < length.get(to, math.inf):
                    length[to] = further
                    heapq.heappush(waiting, (further, to))
        return length

    def on_free_edge(self, shell, point, tolerance):
        corners = list(dict.fromkeys(self.shells[shell]))
        for i, n in enumerate(corners):
            m = corners[(i + 1) % len(corners)]
            users = 0
            for other in self.shells:
                ring = list(dict.fromkeys(other))
                users += any({ring[k], ring[(k + 1) % len(ring)]} == {n, m} for k in range(len(ring)))
            if users != 1:
                continue
            a, b = self.nodes[n], self.nodes[m]
            u = sub(b, a)
            share = min(1, max(0, dot(sub(point, a), u) / dot(u, u)))
            if math.dist([x + share * y for x, y in zip(a, u)], point) / GRID <= tolerance:
                return True
        return False


def unit(v):
    size = math.sqrt(dot(v, v))
    return tuple(x / size for x in v)


def angle_border(cosine, border):
    """1 above the border, 0 below, None too near to say."""
    return None if abs(cosine - border) < MARGIN else int(cosine > border)


def decide(sheets, a, b, gap, paths):
    """None if the pair can't be compared; False if it isn't too close; else its depth, distance and whether an edge touches."""
    mean = (sheets.thickness[a] + sheets.thickness[b]) / 2
    if min(sheets.thickness[a], sheets.thickness[b]) <= 0 or set(sheets.shells[a]) & set(sheets.shells[b]):
        return False
    triangles_a, triangles_b = sheets.triangles(a), sheets.triangles(b)
    if not triangles_a or not triangles_b:
        return False
    points_a = [p for t in triangles_a for p in t]
    points_b = [p for t in triangles_b for p in t]
    apart = max(max(min(p[k] for p in points_b) - max(p[k] for p in points_a), min(p[k] for p in points_a) - max(p[k] for p in points_b))
                for k in range(3))
    if apart / GRID > mean + gap:
        return False
    found = [(*nearest(s, t), s, t) for s in triangles_a for t in triangles_b]
    square = min(x[0] for x in found)
    distance = math.sqrt(square) / GRID
    reach = 0.99 * mean + gap
    if abs(distance - reach) < MARGIN or abs(distance - 0.01 * mean) < MARGIN:
        return None
    if distance > reach:
        return False
    length = paths(a)
    path = min(length.get(n, math.inf) for n in sheets.shells[b])
    if abs(path - 4 * (mean + gap)) < MARGIN:
        return None
    if path < 4 * (mean + gap):
        return False
    answers = set()
    for _, on_a, on_b, s, t in (x for x in found if math.sqrt(x[0]) / GRID <= distance + MARGIN):  # equally near ones: any may decide
        normals = [unit(cross(sub(x[1], x[0]), sub(x[2], x[0]))) for x in (s, t)]
        alike = angle_border(abs(dot(*normals)), math.sqrt(3) / 2)
        if alike is None:
            return None
        if square == 0:  # shells that pass through each other have no single nearest point
            answers.add((True, None))
            continue
        if distance <= 0.01 * mean:
            edges = [sheets.on_free_edge(x, p, 0.01 * mean) for x, p in ((a, on_a), (b, on_b))]
            answers.add((True, all(edges) or (any(edges) and not alike)))
            continue
        direction = unit(sub(on_b, on_a))
        faces = [angle_border(abs(dot(n, direction)), 0.5) for n in normals]
        if None in faces:
            return None
        answers.add((not alike or any(faces), False))
    if len(answers) != 1:
        return None
    counts, touches = answers.pop()
    return (mean + gap - distance, distance, touches) if counts else False


def is_same(said, right):
    return abs(said[0] - right[0]) < 1e-12 and abs(said[1] - right[1]) < 1e-12 and right[2] in (None, said[2])


def trials(rng):
    for n in range(36):
        sheets = Sheets()
        size, sheet_size = rng.choice((0.4, 1.0, 2.0)), rng.randint(2, 4)
        tilt = [rng.uniform(-0.6, 0.6) for _ in range(2)] if n % 3 else [0, 0]
        steep = rng.uniform(0.2, 1.2) if n % 4 == 0 else 0
        rough = rng.choice((0, 0.2)) * size
        lift = rng.choice((0, 0.3, 0.8, 1.1))

        def flat(i, j):
            return size * i + rng.uniform(-rough, rough), size * j + rng.uniform(-rough, rough), rng.uniform(-rough, rough)

        def other(i, j):
            x, y = size * (i + 0.37), size * (0.21 + j * math.cos(steep))
            return (x + rng.uniform(-rough, rough), y + rng.uniform(-rough, rough),
                    lift + size * j * math.sin(steep) + tilt[0] * x + tilt[1] * y + rng.uniform(-rough, rough))

        def folded(i, j):
            turn = math.radians(rng_fold)
            return (size * i, size * j, 0) if j <= 2 else (size * i, size * (2 + (j - 2) * math.cos(turn)), size * (j - 2) * math.sin(turn))
        rng_fold = rng.choice((60, 120, 150, 172, 176))
        if n % 6 == 5:
            sheets.add(3, 8, rng.choice((0.5, 1.0, 1.6)), n % 4 == 1, folded)
        else:
            sheets.add(sheet_size, sheet_size, rng.choice((0.5, 1.0)), n % 2 == 1, flat)
            sheets.add(sheet_size, sheet_size, rng.choice((0.7, 1.0, 1.4)), n % 5 == 1, other)
        if n % 7 == 3:
            sheets.thickness[0] = 0.0
        yield sheets, rng.choice((0.0, 0.0, 0.25))


def main():
    cases = list(trials(random.Random(11)))
    text = "\n".join(sheets.text(gap) for sheets, gap in cases) + "\n"
    words = iter(subprocess.run([sys.argv[1]], input=text, capture_output=True, text=True, check=True).stdout.split())
    compared = close = unsure = wrong = 0
    for number, (sheets, gap) in enumerate(cases):
        found = {}
        for _ in range(int(next(words))):
            a, b, distance, depth, touches = (next(words) for _ in range(5))
            found[int(a), int(b)] = (float(depth), float(distance), touches == "1")
        known = {}

        def paths(shell):
            if shell not in known:
                known[shell] = sheets.paths(shell)
            return known[shell]
        for a in range(len(sheets.shells)):
            for b in range(a + 1, len(sheets.shells)):
                right = decide(sheets, a, b, gap, paths)
                if right is None:
                    unsure += 1
                    continue
                compared += 1
                close += bool(right)
                said = found.get((a, b), False)
                if bool(said) == bool(right) and (not right or is_same(said, right)):
                    continue
                wrong += 1
                if wrong <= 5:
                    print(f"sheets {number}, shells {a} and {b}: {said}, expected {right}")
    print(f"{compared} pairs, {close} too close, {unsure} at a border, {wrong} wrong")
    assert close >= 300 and unsure < close / 4, "too few pairs are compared"
    sys.exit(wrong != 0)


if __name__ == "__main__":
    main()
