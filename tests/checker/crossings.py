#!/usr/bin/env python3
"""Which triangles cross, in exact fractions, against the program: crossings.py TRIANGLE_PAIRS

A pair of triangles crosses if each has corners on both sides of the other's plane and the pieces that they cut from the planes' line
share more than a point. Two sheets of two triangles also cross along a common side: there it is decided by angles about the side. The
program's own way, signs of four corners, isn't used here.
"""
import math
import random
import subprocess
import sys
from fractions import Fraction


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def exact(points):
    return [[Fraction(x) for x in p] for p in points]


def normal(t):
    return cross(sub(t[1], t[0]), sub(t[2], t[0]))


def piece_on_line(t, plane, along):
    """What the plane's line cuts from the triangle, as the range of dot(point, along); None without corners on both sides."""
    n = normal(plane)
    heights = [dot(n, sub(p, plane[0])) for p in t]
    if not (min(heights) < 0 < max(heights)):
        return None
    places = []
    for i in range(3):
        j = (i + 1) % 3
        if heights[i] == 0:
            places.append(dot(t[i], along))
        if heights[i] * heights[j] < 0:
            share = heights[i] / (heights[i] - heights[j])
            places.append(dot([a + share * (b - a) for a, b in zip(t[i], t[j])], along))
    return min(places), max(places)


def triangles_cross(a, b):
    along = cross(normal(a), normal(b))
    of_a, of_b = piece_on_line(a, b, along), piece_on_line(b, a, along)
    return of_a is not None and of_b is not None and max(of_a[0], of_b[0]) < min(of_a[1], of_b[1])


def is_flat(t):
    return normal(t) == [0, 0, 0]


def points_near(axis_point, along, across, up, point):
    """The direction from the axis to the point, as (cosine's sign and size, sine)."""
    d = sub(point, axis_point)
    return dot(d, across), dot(d, up)


def half(direction):
    return 0 if direction[1] > 0 or (direction[1] == 0 and direction[0] > 0) else 1


def turn_key(directions):
    """Ranks directions in a plane by angle, exactly; equal angles have equal ranks."""
    import functools

    def compare(u, v):
        if half(u) != half(v):
            return half(u) - half(v)
        turn = u[0] * v[1] - u[1] * v[0]
        return -1 if turn > 0 else 1 if turn < 0 else 0
    ranks, rank = {}, 0
    ordered = sorted(directions, key=functools.cmp_to_key(compare))
    for before, direction in zip([None] + ordered, ordered):
        if before is not None and compare(before, direction) != 0:
            rank += 1
        ranks[direction] = rank
    return ranks


def alternate_about(axis, a, b):
    along = sub(axis[1], axis[0])
    across = cross(along, [1, 0, 0])
    if across == [0, 0, 0]:
        across = cross(along, [0, 1, 0])
    up = cross(along, across)
    # `across` and `up` differ in length by a factor; angles about the axis stay in order
    directions = [points_near(axis[0], along, across, up, p) for p in a + b]
    ranks = turn_key(directions)
    kinds = sorted((ranks[d], kind) for d, kind in zip(directions, "aabb"))
    return len({rank for rank, _ in kinds}) == 4 and "".join(kind for _, kind in kinds) in ("abab", "baba")


def inside(side, triangle):
    """Whether a side in the triangle's plane passes through its inside."""
    n = normal(triangle)
    low, high = Fraction(0), Fraction(1)
    for i in range(3):
        inward = cross(n, sub(triangle[(i + 1) % 3], triangle[i]))
        at, to = (dot(inward, sub(p, triangle[i])) for p in side)
        if at == to:
            if at <= 0:
                return False
        elif to > at:
            low = max(low, -at / (to - at))
        else:
            high = min(high, at / (at - to))
    return low < high


def sheets_cross(a, b):
    """Each sheet: the two ends of a common side, then a corner for each triangle."""
    of_a = [[a[0], a[1], c] for c in a[2:] if not is_flat([a[0], a[1], c])]
    of_b = [[b[0], b[1], c] for c in b[2:] if not is_flat([b[0], b[1], c])]
    if any(triangles_cross(s, t) for s in of_a for t in of_b):
        return True
    for sheet, others in ((of_a, of_b), (of_b, of_a)):
        for t in others:
            if len(sheet) == 2:
                heights = [[dot(normal(t), sub(p, t[0])) for p in s] for s in sheet]
                if heights[0][0] == heights[0][1] == 0 and heights[0][2] * heights[1][2] < 0 and inside(sheet[0][:2], t):
                    return True
    if len(of_a) == 2 and len(of_b) == 2 and is_flat([a[0], a[1], b[0]]) and is_flat([a[0], a[1], b[1]]):
        along = sub(a[1], a[0])
        places = [sorted(dot(p, along) for p in sheet[:2]) for sheet in (a, b)]
        if max(places[0][0], places[1][0]) < min(places[0][1], places[1][1]):
            return alternate_about(a[:2], a[2:], b[2:])
    return False


def ulps(x, steps):
    for _ in range(abs(steps)):
        x = math.nextafter(x, math.inf if steps > 0 else -math.inf)
    return x


def trial_points(rng, count, kind):
    if kind == 0:  # a coarse lattice: most are degenerate in some way
        return [[float(rng.randint(0, 2)) for _ in range(3)] for _ in range(count)]
    if kind == 1:
        return [[rng.uniform(-1, 1) for _ in range(3)] for _ in range(count)]
    if kind == 2:  # nearly in a plane, some ulps from it
        points = [[rng.uniform(0, 1), rng.uniform(0, 1)] for _ in range(count)]
        return [[x, y, ulps(0.3 * x + 0.7 * y + 0.1, rng.randint(-2, 2))] for x, y in points]
    offset = [rng.choice((1e6, -1e3, 0.1)) for _ in range(3)]  # a lattice far from the origin, with the rounding of its places
    return [[o + 0.1 * rng.randint(0, 3) for o in offset] for _ in range(count)]


def trials(rng):
    for n in range(320):
        yield "side", trial_points(rng, 4, n % 4)
        yield "pair", trial_points(rng, 6, n % 4)
    for n in range(640):
        points = trial_points(rng, 8, (0, 0, 1, 3)[n % 4])
        if n % 3 == 0:  # on one line, so that both sides are shared
            points[4:6] = rng.choice((points[0:2], points[1::-1]))
        yield "sheets", points


def expected(kind, points):
    p = exact(points)
    if kind == "side":
        value = dot(normal(p[:3]), sub(p[3], p[0]))
        return (value > 0) - (value < 0)
    if kind == "pair":
        return int(not is_flat(p[:3]) and not is_flat(p[3:]) and triangles_cross(p[:3], p[3:]))
    return int(sheets_cross(p[:4], p[4:]))


def main():
    cases = list(trials(random.Random(7)))
    text = "\n".join(" ".join([kind] + [repr(x) for p in points for x in p]) for kind, points in cases)
    answers = [int(x) for x in subprocess.run([sys.argv[1]], input=text, capture_output=True, text=True, check=True).stdout.split()]
    assert len(answers) == len(cases), "an answer for each case"
    wrong = 0
    counts = {}
    for (kind, points), answer in zip(cases, answers):
        right = expected(kind, points)
        counts[kind, right] = counts.get((kind, right), 0) + 1
        if answer != right:
            wrong += 1
            if wrong <= 5:
                print(f"{kind} {points}: {answer}, expected {right}")
    print(f"{len(cases)} cases, {wrong} wrong; answers: {counts}")
    assert all(counts.get((kind, 1), 0) >= 20 for kind in ("side", "pair", "sheets")), "too few cases cross"
    sys.exit(wrong != 0)


if __name__ == "__main__":
    main()
