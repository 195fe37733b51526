"""Nodes of welds that lie on sheets and follow them, by the rules of docs/connections.md: an edit may move them too, by exactly what the sheet
under them moves."""
SHELLS = ("shell", "sh3n", "element")


class Sheets:
    """The shells of a deck and what an edit moves of them; wanted: {node: displacement}."""

    def __init__(self, deck, wanted):
        self.deck, self.wanted = deck, wanted
        self.shells = [e for e in deck.elements if e.cls in SHELLS and len(corners(e, deck)) >= 3]
        self.in_shells = {n for e in self.shells for n in e.nodes}
        self.in_others = {n for e in deck.elements if e.cls not in SHELLS or len(corners(e, deck)) < 3 for n in e.nodes}
        self.places = {}

    def place(self, id):
        if id not in self.places:
            self.places[id] = self.deck.nodes[id].basic()
        return self.places[id]

    def carried(self, id):
        """By how much the sheet moves on which the node lies; None if it is no weld's node or lies on no sheet."""
        if id in self.in_shells or id not in self.in_others:
            return None
        p, best = self.place(id), None
        for shell in self.shells:
            ids = corners(shell, self.deck)
            points = [self.place(n) for n in ids]
            reach = 2 * max(distance(points[0], q) for q in points)
            if distance(points[0], p) > reach:
                continue
            for three in ((0, 1, 2), (0, 2, 3))[: len(ids) - 2]:
                shares = closest_shares([points[k] for k in three], p)
                at = mixed(shares, [points[k] for k in three])
                if best is None or distance(at, p) < best[0]:
                    side = sum(distance(points[k], points[k - 1]) for k in range(len(points))) / len(points)
                    best = (distance(at, p), side, shares, [ids[k] for k in three])
        if best is None or best[0] > 0.25 * best[1]:  # a sheet thicker than a quarter of its elements isn't among the decks
            return None
        zero = (0.0, 0.0, 0.0)
        return mixed(best[2], [self.wanted.get(n, zero) for n in best[3]])


def corners(e, deck):
    ids = []
    for n in e.nodes[:4]:
        if n and n not in ids and n in deck.nodes:
            ids.append(n)
    return ids


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def mixed(shares, points):
    return tuple(sum(s * q[k] for s, q in zip(shares, points)) for k in range(3))


def closest_shares(triangle, p):
    """Of the corners, at the point of the triangle nearest to p: over the face, else over the best of the sides."""
    a, b, c = triangle
    u, v, w = ([y - x for x, y in zip(a, q)] for q in (b, c, p))
    uu, uv, vv, wu, wv = dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)
    det = uu * vv - uv * uv
    if det > 0:
        s, t = (vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det
        if s >= 0 and t >= 0 and s + t <= 1:
            return (1 - s - t, s, t)
    best = None
    for i, j in ((0, 1), (1, 2), (2, 0)):
        along = [y - x for x, y in zip(triangle[i], triangle[j])]
        length2 = dot(along, along)
        s = min(1.0, max(0.0, dot([y - x for x, y in zip(triangle[i], p)], along) / length2)) if length2 else 0.0
        shares = [0.0, 0.0, 0.0]
        shares[i], shares[j] = 1 - s, s
        d = distance(mixed(shares, triangle), p)
        if best is None or d < best[0]:
            best = (d, tuple(shares))
    return best[1]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))
