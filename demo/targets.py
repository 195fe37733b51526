"""What the demo shapes of a deck: named places of the sample, and places found by the figures of any other deck."""
from programs import Stop, figures

SAMPLE_FACE = [1180.0, -84.0, 0.0]  # the sill's outer face
SAMPLE_END = [1640.0, -84.0, 0.0]  # the rail's free end
SAMPLE_LENGTHENED = 150.0
# Seen from the side: 1,000 mm are half of the picture's width.
SAMPLE_SIDE = [0.001, 0, 0, 0, 0, 0, 0.001, 0, 0, 0.001, 0, 0, 0, 0, 0, 1]
SAMPLE_REAR = [[1.35, -0.1], [1.7, -0.1], [1.7, 0.1], [1.35, 0.1]]

SAMPLE_LIFT_SIZES = 2.0  # target sizes
LIFT_SIZES = 1.0
MAX_STRAIN = 0.7  # of a stretch: elements become longer by this share
MAX_PARTS = 6  # that are tried, the largest first


class Lift:
    """What is selected, and the lift of it."""

    def __init__(self, what, select, distance, **more):
        self.what, self.select = what, select
        self.edit = {"edit": "lift", "distance": distance, **more}


class Stretch:
    """An edit that makes something longer. `parts`: an expression of what the pictures show of it."""

    def __init__(self, what, edit, parts):
        self.what, self.edit, self.parts = what, edit, parts


def sample_lift(size):
    select = [{"edit": "select_region", "at": SAMPLE_FACE, "angle": 30}]
    return [Lift("the outer face of rail and sill", select, SAMPLE_LIFT_SIZES * size, grab=SAMPLE_FACE, falloff={"profile": "gaussian"})]


def sample_stretch():
    rear = {"edit": "select_lasso", "view": SAMPLE_SIDE, "outline": SAMPLE_REAR}
    edit = {"edit": "translate", "on": rear, "by": [SAMPLE_LENGTHENED, 0, 0], "grab": SAMPLE_END, "origin": "free_edge",
            "falloff": {"profile": "linear"}, "across_welds": True}  # fmt: skip
    return [Stretch(f"the rail's free end by {SAMPLE_LENGTHENED:g} mm", edit, "1,2,6")]


def large_parts(deck):
    """The parts with the most shells, largest first."""
    parts = [part for part in figures("info", deck)["parts"] if part["box"] and part["quads"] + part["tris"] > 0]
    if not parts:
        raise Stop(f"{deck} has no shells to shape")
    return sorted(parts, key=lambda part: (-(part["quads"] + part["tris"]), part["id"]))[:MAX_PARTS]


def lifts(deck, size):
    """Faces of the large parts, each the one nearest to the middle of its part; their rims stay."""
    for part in large_parts(deck):
        middle = [(a + b) / 2 for a, b in zip(*part["box"])]
        select = [{"edit": "only", "on": str(part["id"])}, {"edit": "select_region", "at": middle, "angle": 30}]
        yield Lift(f"a face of part {part['id']}", select, LIFT_SIZES * size, free_ends=False)


def stretches(deck):
    """For each large part: the third at an end of its longest extent is stretched, and what lies beyond moves along. So nothing tears."""
    for part in large_parts(deck):
        low, high = part["box"]
        axis = max(range(3), key=lambda k: high[k] - low[k])
        long = high[axis] - low[axis]
        if not long > 0:
            continue
        for sign in (1, -1):
            yield end_stretch(part, axis, sign, long)


def end_stretch(part, axis, sign, long):
    low, high = part["box"]
    end = high[axis] if sign > 0 else low[axis]
    plane = end - sign * long / 3
    others = [k for k in range(3) if k != axis]
    # Along the axis the outline goes far beyond every deck; across it even farther.
    reach = 1e3 * max(abs(c) for c in low + high) + 1e3 * long
    scale = 1 / reach
    view = [0.0] * 16
    for row, k in enumerate([axis, *others]):
        view[4 * k + row] = scale
    view[15] = 1.0
    outline = [[plane * scale, -2.0], [sign * 2.0, -2.0], [sign * 2.0, 2.0], [plane * scale, 2.0]]
    by = MAX_STRAIN * long / 3
    direction = [sign * float(k == axis) for k in range(3)]
    grab = [end if k == axis else (low[k] + high[k]) / 2 for k in range(3)]
    edit = {"edit": "translate", "on": {"edit": "select_lasso", "view": view, "outline": outline}, "by": [by * d for d in direction], "grab": grab,
            "falloff": {"profile": "linear", "along": direction}, "across_welds": True}  # fmt: skip
    return Stretch(f"the end of part {part['id']} by {by:.3g} along {'-' if sign < 0 else ''}{'xyz'[axis]}", edit, str(part["id"]))
