"""What the tool describe_edit of prismesh.mcp tells: the fields of each edit in short. docs/edits.md has the whole.

tests/python/mcp_test.py holds the names, defaults and examples to that page and to the core.
"""
from __future__ import annotations

from typing import Any

Field = dict[str, Any]
LENGTH, ANGLE = "the deck's length unit", "degrees"


def _field(name: str, form: str, meaning: str, unit: str | None = None, **more: Any) -> Field:
    """more: required=True; default=the value in JSON; without=what holds without the field, where that isn't one value."""
    return {"name": name, **more, "form": form, **({"unit": unit} if unit else {}), "meaning": meaning}


_POINT = "[x, y, z]"
_NODE = "a node's id, or [x, y, z]"
_MODE = _field("mode", "set, add, subtract or intersect", "how the result is combined with the selection", default="set")
_RINGS = [_field("rings", "a whole number, 1 to 1,000,000", "how many rings", default=1)]
_ON_PARTS = [_field("on", 'an expression of parts like "3,7" or "all"', "which parts", without="the parts of the selection")]
_FALLOFF = ('{"profile": constant, linear, smooth, sharp, root, sphere, inverse_square or gaussian, "flat": 0 to 1, the share that keeps weight 1, '
            '"along": [x, y, z], the only direction in which the weight falls}')
_SHAPING = [
    _field("on", "an expression of nodes, or a select, select_region, select_lasso or select_flange edit as an object", "the nodes to move", without="the selection"),
    _field("grab", _NODE, "the grabbed node, which moves by the whole displacement", LENGTH, without="the node farthest from the border"),
    _field("grab_at", _POINT, "where the node grab was; used where grab isn't among the nodes to move", LENGTH, without="not used"),
    _field("falloff", _FALLOFF, "how the weight falls from the grab to the border of the nodes to move", default={"profile": "smooth"}),
    _field("free_ends", 'true or "rigid", "weighted", false or "held"', "what happens to free edges: they move as a whole, by their weight, or stay", default=True),
    _field("origin", "grab or free_edge", "free_edge: a whole free edge is pulled", default="grab"),
    _field("origin_at", _NODE, "with origin free_edge: on that edge or near it", LENGTH, without="the edge beyond the grab"),
    _field("across_welds", "true or false", "pieces joined by welds take the weight of what they are joined to", default=False),
    _field("symmetry", '{"point": [x, y, z], "normal": [x, y, z]}', "makes the mirrored edit on the other side of this plane too", LENGTH, without="none"),
    _field("max_move", "a number above 0", "the largest displacement of any node", LENGTH, without="no limit"),
    _field("contact", "allow, refuse or keep_apart", "what to do where shells would cross or come too close", default="allow"),
]
_CONTACT = _SHAPING[-1]
_BY = _field("by", _POINT, "displacement of the grab", LENGTH, required=True)
_EDGE_ANGLE = _field("angle", "0 to 180", "edges sharper than this are features", ANGLE, default=30)
_LIMITS = _field("max_move", '{"free": number, "line": number}', "largest displacement of a node inside a sheet, and on a feature line", LENGTH, without="no limit")
_SCOPES = "selection, part, all, damaged or failed"
_FLANGE = '{"at": a node\'s id or [x, y, z]} or {"between": an expression of parts}, with "gap" and "max_width" as of select_flange'
_GAP = _field("gap", "a number, at least 0", "sheets may be farther apart than by their thickness by this; needed where parts have no thickness", LENGTH, default=0)
_MATERIAL = [
    _field("density", "a number above 0", "of the new material", "the deck's units", without="of the sheets (weld); required without like (bond)"),
    _field("youngs_modulus", "a number above 0", "of the new material", "the deck's units", without="of the sheets (weld); required without like (bond)"),
    _field("poissons_ratio", "0 to 0.5", "of the new material", without="of the sheets (weld); required without like (bond)"),
]
_AT_SHELLS = '["shell:12"], ["shell:12", "shell:13"] or the two nodes of an edge, ["node:7", "node:8"]'

# name: what it does, its fields, an example
EDITS: dict[str, tuple[str, list[Field], dict[str, Any]]] = {
    "select": ("Selects by an expression of ids, sets and files; the tool select does it too.", [
        _field("expr", "an expression", 'what to select: "1-100,205,!17", "part:3", "shell:7", "set:17", "file:bumper.k", "all"', required=True),
        _field("kind", "node, element or part", "what the expression's bare ids are", default="node"), _MODE],
        {"edit": "select", "expr": "1-100,!17,part:1", "kind": "node", "mode": "add"}),
    "select_region": ("Selects a region of the surface around a node or a point.", [
        _field("at", _NODE, "where the region begins", LENGTH, required=True),
        _field("angle", "0 to 180", "creases and fillets that bend by more bound the region", ANGLE, default=30),
        _field("by", "features, creases, part, piece or free_edge", "what bounds the region", default="features"),
        _field("across_welds", "true or false", "the region continues on welded sheets", default=False), _MODE],
        {"edit": "select_region", "at": [20, 40, 0], "angle": 30}),
    "select_lasso": ("Selects the nodes inside a closed outline on a screen.", [
        _field("outline", "3 to 100,000 points [x, y]", "the outline in normalised device coordinates", required=True),
        _field("view", "16 numbers, column-major", "the matrix from deck coordinates to clip space", required=True),
        _field("visible", "true or false", "only nodes that no visible shell hides", default=False), _MODE],
        {"edit": "select_lasso", "outline": [[-0.5, -0.5], [0.5, -0.5], [0, 0.5]], "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}),
    "select_flange": ("Selects the shells of all sheets of the flange at a place, or of all flanges between parts.", [
        _field("at", _NODE, "a place on the flange; this or between", LENGTH, without="between is needed"),
        _field("between", "an expression of parts", "all flanges with at least two sheets of these; this or at", without="at is needed"),
        _GAP, _field("max_width", "a number above 0", "wider bands are no flanges", LENGTH, without="40 times the mean thickness, and gap"), _MODE],
        {"edit": "select_flange", "between": "part:1", "mode": "add"}),
    "grow": ("Adds rings of neighbours to the selection.", _RINGS, {"edit": "grow", "rings": 2}),
    "shrink": ("Removes rings at the rim of the selection.", _RINGS, {"edit": "shrink", "rings": 1}),
    "invert": ("Selects what was not selected and deselects the rest.", [], {"edit": "invert"}),
    "hide": ("Hides parts.", _ON_PARTS, {"edit": "hide", "on": "2"}),
    "show": ("Shows parts.", _ON_PARTS, {"edit": "show", "on": "all"}),
    "only": ("Shows these parts and hides all others.", _ON_PARTS, {"edit": "only", "on": "1"}),
    "reverse": ("Shows the hidden ones and hides the visible ones, of these parts.", [_ON_PARTS[0] | {"without": "all parts"}], {"edit": "reverse"}),
    "lock": ("Locks parts: their nodes can't move.", _ON_PARTS, {"edit": "lock", "on": "2"}),
    "unlock": ("Unlocks parts.", _ON_PARTS, {"edit": "unlock", "on": "all"}),
    "set_target_size": ("Sets the element size that shells of parts are judged by.", [
        _field("size", 'a number above 0, "part" (each part\'s median edge) or "deck" (the deck\'s)', "the target size", LENGTH, required=True), *_ON_PARTS],
        {"edit": "set_target_size", "size": 5, "on": "1"}),
    "set_criteria": ("Sets the quality criteria that parts are judged by.", [
        _field("criteria", 'a built-in set (default, strict, skew_and_thickness), a criteria file, or "deck"', "the criteria; a file's path is relative to the deck's folder", required=True),
        _field("text", "a text", "the file's content; then no file is read", without="the file is read"), *_ON_PARTS],
        {"edit": "set_criteria", "criteria": "strict", "on": "1"}),
    "translate": ("Moves each node by its weight times a displacement.", [_BY, *_SHAPING],
                  {"edit": "translate", "by": [0, 0, 2.5], "on": "45-60,70", "falloff": {"profile": "gaussian", "flat": 0.3}}),
    "lift": ("Moves each node along the surface normal by its weight times a distance.", [
        _field("distance", "a number", "displacement of the grab along the surface normal there", LENGTH, required=True),
        _field("normals", "grab or each", "all nodes along the normal at the grab, or each along its own", default="grab"), *_SHAPING],
        {"edit": "lift", "distance": -1.5, "on": {"edit": "select_region", "at": [20, 40, 0]}, "max_move": 1}),
    "slide": ("Moves each node along the surface, over the faces as they were.", [_BY, *_SHAPING], {"edit": "slide", "by": [2, 0, 0], "on": "45-60,70"}),
    "rotate": ("Turns each node about an axis by its weight times an angle.", [
        _field("point", _POINT, "a point on the axis", LENGTH, required=True), _field("axis", _POINT, "its direction, of any length but 0", required=True),
        _field("degrees", "−36,000 to 36,000", "the angle, right-handed", ANGLE, required=True), *_SHAPING],
        {"edit": "rotate", "point": [0, 40, 0], "axis": [1, 0, 0], "degrees": 10, "on": "45-60", "falloff": {"profile": "constant"}}),
    "move": ("A rigid motion: turns each node about an axis by its weight times an angle, then moves it.", [
        _field("by", _POINT, "displacement of the grab after the turn", LENGTH, default=[0, 0, 0]), _field("point", _POINT, "a point on the axis", LENGTH, default=[0, 0, 0]),
        _field("axis", _POINT, "its direction, of any length but 0", default=[0, 0, 1]), _field("degrees", "−36,000 to 36,000", "the angle, right-handed", ANGLE, default=0), *_SHAPING],
        {"edit": "move", "by": [0, 0, 4], "degrees": 5, "on": "45-60"}),
    "relax": ("Moves nodes along the surface until the elements have better shapes.", [
        _field("mode", "full or from", "all nodes of the scope, or from a node outwards", default="full"),
        _field("at", _NODE, "the start node; required with mode from", LENGTH, without="mode full"),
        _field("threshold", "a number above 0", "with mode from: as far as nodes move by more", LENGTH, without="0.15 of the target size of the part at at"),
        _field("scope", _SCOPES, "which nodes", default="selection"), _EDGE_ANGLE, _LIMITS, _CONTACT],
        {"edit": "relax", "scope": "all"}),
    "repair": ("Changes the mesh around failing and warning elements until they pass or nothing improves them.", [
        _field("scope", _SCOPES, "which elements", default="damaged"), _EDGE_ANGLE, _LIMITS,
        _field("on_cancel", "discard", "keep isn't possible with this server", default="discard"),
        _field("stop_at", '{"attempt": 1, "steps": [532, 0]}', "ends the repair there, as a journal writes it", without="nowhere"), _CONTACT],
        {"edit": "repair", "scope": "failed"}),
    "separate": ("Moves shells that cross or are too close apart, region by region.", [
        _field("on", "an expression of elements", "regions with these on one side", without="all"), _field("against", "an expression of elements", "and these on the other", without="all"),
        _field("at", _POINT, "only the region nearest to it", LENGTH, without="all regions"),
        _field("kinds", "a list of perforation and penetration", "shells that cross, shells that are too close", without="both"),
        _field("joined", "true or false", "also between parts that welds, adhesives or ties join there", default=False),
        _field("gap", "a number, at least 0", "how far the faces must be apart", LENGTH, default=0), _field("move", "both, on or against", "which side moves", default="both"),
        _field("direction", _POINT, "the line along which sides move", without="away from the other side"),
        _field("max_move", "a number above 0", "a region in which a node needs more is left", LENGTH, without="no limit"),
        _field("allowed_depth", "a number, at least 0", "penetrations up to it stay", LENGTH, default=0),
        _field("follow", "none, relax or repair", "what is done to the shells that moved", default="none")],
        {"edit": "separate", "kinds": ["penetration"], "max_move": 3}),
    "split": ("Divides a quad, or two shells with a common edge.", [_field("at", _AT_SHELLS, "a quad, or two shells with a common edge", required=True)],
              {"edit": "split", "at": ["shell:12"]}),
    "collapse": ("Collapses an edge.", [_field("at", _AT_SHELLS, "a shell (its shortest edge), two shells (their common edge), or an edge's nodes", required=True)],
                 {"edit": "collapse", "at": ["node:30", "node:31"]}),
    "merge": ("Makes a quad of two triangles with a common edge.", [_field("at", _AT_SHELLS, "two triangles", required=True)],
              {"edit": "merge", "at": ["shell:12", "shell:13"]}),
    "swap": ("Swaps the common edge of two shells.", [_field("at", _AT_SHELLS, "two shells with a common edge", required=True)],
             {"edit": "swap", "at": ["shell:12", "shell:13"]}),
    "weld": ("Adds spot welds along a flange, along a line, at points or those of a table: one of flange, along, points, points_file.", [
        _field("flange", _FLANGE, "the flange, or all flanges between parts", LENGTH, without="one of the four is needed"),
        _field("along", "points [x, y, z]", "a line", LENGTH, without="one of the four is needed"), _field("points", "points [x, y, z]", "places", LENGTH, without="one of the four is needed"),
        _field("points_file", "a path relative to the deck's folder", "a table of points with columns x, y, z", LENGTH, without="one of the four is needed"),
        _field("pitch", "a number above 0", "how far apart the welds are; required with flange and along", LENGTH, without="with points"),
        _field("end_distance", "a number, at least 0", "of the first and last weld from the ends", LENGTH, without="half the pitch"),
        _field("edge_distance", "a number, at least 0", "with flange: spots nearer to one of its sides are left out", LENGTH, without="any"),
        _field("sheets", "2 to 6", "how many of the sheets that lie on each other are joined", without="all"), _field("parts", "an expression of parts", "only their sheets count", without="all"), _GAP,
        _field("like", 'an element like "beam:9", or "nearest"', "an existing weld whose part, section, material and contact the new ones get", without="a new part is made"),
        _field("diameter", "a number above 0", "of the welds; required without like", LENGTH, without="that of like"), *_MATERIAL,
        _field("yield_stress", "a number above 0", "of the new material", "the deck's units", without="of the sheets"),
        _field("as", "beam, spring, cweld, cfast or fastener", "which element is made; each format has its own, Nastran cweld and cfast", without="the format's usual one, or that of like")],
        {"edit": "weld", "along": [[0, 10, 0], [60, 10, 0]], "pitch": 20, "sheets": 2, "diameter": 6}),
    "bond": ("Fills the gap between the two sheets of a flange with a strip of hexahedra (LS-DYNA, Abaqus).", [
        _field("flange", _FLANGE, "the flange, or all flanges between parts", LENGTH, required=True), _field("width", "a number above 0", "of the strip across the flange", LENGTH, required=True),
        _field("length", "a number above 0", "of a hexahedron along the flange, about", LENGTH, required=True),
        _field("end_distance", "a number, at least 0", "of the strip from the flange's ends", LENGTH, default=0),
        _field("from", "faces or middles", "between the sheets' faces, or their middle surfaces", default="faces"),
        _field("like", 'a solid like "solid:9"', "whose part and card the new ones get", without="a new part is made"), *_MATERIAL],
        {"edit": "bond", "flange": {"between": "1"}, "width": 10, "length": 8, "density": 1.2e-9, "youngs_modulus": 2000, "poissons_ratio": 0.4}),
    "repair_welds": ("Puts loose ends of welds back onto sheets.", [
        _field("at", 'a list like ["beam:9", "spring:4"]', "only these welds", without="all"), _GAP,
        _field("max_move", "a number above 0", "how far an end may move", LENGTH, without="as long as a joint at the sheet may be")],
        {"edit": "repair_welds"}),
    "replace_part": ("Gives a part the mesh of a part of another deck.", [
        _field("part", "a part's id", "the part that gets the mesh", required=True), _field("deck", "a path relative to the deck's folder", "the other deck", required=True),
        _field("with", "a part's id", "which of its parts", without="the only part with shells"),
        _field("align", '"as_it_stands" or [[3 points], [3 points]]', "points of the variant and of the deck; nodes by id, or [x, y, z]", LENGTH, default="as_it_stands"),
        _field("units", "same, mm, m or in", "of the variant's lengths", without="guessed"),
        _field("tolerance", "a number above 0", "what was at a node goes to the nearest new node within it", LENGTH, without="three quarters of the mean side of the new shells"),
        _field("mesh", "an object with nodes and shells", "the mesh itself, as a journal keeps it; then the deck isn't read", without="the deck is read")],
        {"edit": "replace_part", "part": 1, "deck": "variant.k", "with": 7, "tolerance": 4}),
    "undo": ("Takes the last edit back; the tool undo does it too.", [], {"edit": "undo"}),
    "redo": ("Does again what undo took back; the tool redo does it too.", [], {"edit": "redo"}),
    "branch": ("Makes redo lead to a branch of the history that begins here.", [_field("number", "a whole number", "which branch", required=True)], {"edit": "branch", "number": 1}),
}
