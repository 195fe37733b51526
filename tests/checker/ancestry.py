"""Where a new element comes from: the old ones of its part that an edit changed or removed, and the patch of elements that it lies in."""
import math

SHELL_CLASSES = {"shell", "sh3n"}  # Radioss counts triangles in ids of their own; a quad may become one


def family(element):
    return "shell" if element.cls in SHELL_CLASSES else element.cls


class Ancestry:
    def __init__(self, before, after, nodes_moved_freely):
        self.before, self.after, self.nodes_moved_freely = before, after, nodes_moved_freely
        new = {(e.cls, e.id): e.nodes for e in after.elements}
        self.known, self.grids = {}, {}
        self.gone = {}  # (family, part): old elements that were changed or removed
        for e in before.elements:
            if new.get((e.cls, e.id)) != e.nodes:
                self.gone.setdefault((family(e), e.part), []).append(e)

    def parents(self, element):
        """Old elements of its part that were removed or changed. Where an edit divides once, they share two nodes with it, or all but the
        new ones. A repair divides, swaps and collapses in several rounds what it has divided before, so that all nodes of a new shell but
        one may be new, or all. There its place tells: its centre is no farther from its parent's than half of both widths, which leaves room
        for what relaxing does afterwards (on twelve real repairs it was within a third)."""
        key = element.cls, element.id
        if key not in self.known:
            self.known[key] = self.by_place(element) if self.nodes_moved_freely else self.by_nodes(element)
        return self.known[key]

    def by_nodes(self, element):
        mine = set(element.nodes) & self.before.nodes.keys()
        return [e for e in self.gone.get((family(element), element.part), ()) if len(mine & set(e.nodes)) >= min(2, len(mine))]

    def by_place(self, element):
        whose = family(element), element.part
        if whose not in self.grids:
            self.grids[whose] = Grid([(e, *self.where_it_was(e)) for e in self.gone.get(whose, ())])
        centre, size = extent(self.after, element.nodes)
        return [e for e, there, width in self.grids[whose].about(centre, size) if math.dist(centre, there) <= 0.5 * (size + width)]

    def where_it_was(self, element):
        """An old element's centre and width after whatever moved it, by those of its nodes that are still there."""
        left = [n for n in element.nodes if n in self.after.nodes]
        there, width = extent(self.after, left) if left else extent(self.before, element.nodes)
        return there, max(width, extent(self.before, element.nodes)[1])

    def loose(self, added):
        """Of the new shells those of patches, joined by edges, in which no old shell of their part is and that no old one has an edge with."""
        old = {(e.cls, e.id) for e in self.before.elements}
        at_edge = {}
        for e in self.after.elements:
            if e.cls in SHELL_CLASSES:
                for edge in edges(e):
                    at_edge.setdefault((edge, e.part), []).append(e)
        seen, loose = set(), []
        for first in added:
            if first.cls not in SHELL_CLASSES or (first.cls, first.id) in seen:
                continue
            patch, holds = [first], False
            seen.add((first.cls, first.id))
            for e in patch:
                for edge in edges(e):
                    for other in at_edge[edge, e.part]:
                        if (other.cls, other.id) in old:
                            holds = True
                        elif (other.cls, other.id) not in seen:
                            seen.add((other.cls, other.id))
                            patch.append(other)
            if not holds:
                loose += patch
        return loose


class Grid:
    """Elements by cells as wide as the widest."""

    def __init__(self, elements):
        self.elements, self.cells = elements, {}
        self.cell = max((width for _, _, width in elements), default=0.0) or 1.0
        for entry in elements:
            self.cells.setdefault(self.cell_of(entry[1]), []).append(entry)

    def cell_of(self, point):
        return tuple(math.floor(x / self.cell) for x in point)

    def about(self, centre, size):
        if size > self.cell:
            return self.elements
        x, y, z = self.cell_of(centre)
        return [e for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) for e in self.cells.get((x + i, y + j, z + k), ())]


def corners(element):
    return [n for i, n in enumerate(element.nodes[:4]) if n and n not in element.nodes[:i]]


def edges(element):
    c = corners(element)
    return [frozenset((n, c[i - 1])) for i, n in enumerate(c)]


def extent(deck, nodes):
    """Centre, and the greatest distance between two of them."""
    p = [deck.nodes[n].basic() for n in set(nodes[:4]) if n in deck.nodes]
    if not p:
        return (0.0,) * 3, 0.0
    return tuple(sum(q[i] for q in p) / len(p) for i in range(3)), max(math.dist(a, b) for a in p for b in p)
