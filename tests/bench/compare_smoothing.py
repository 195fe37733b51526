#!/usr/bin/env python3
"""Relaxing beside Laplacian smoothing: quality gained and surface lost, on surfaces that are known and on a real part.

    compare_smoothing.py PRISMESH [MODELS]

PRISMESH is the program; MODELS the folder of real decks (without it the real part is left out). Prints the table of docs/relaxing.md.
Smoothing is VTK's (python3-vtk9: vtkSmoothPolyDataFilter, vtkWindowedSincPolyDataFilter) with its defaults for boundaries; without it the
script says so and ends with status 77. Quality is judged by `prismesh check` for all of them.
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

try:
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import (vtkImplicitPolyDataDistance, vtkSmoothPolyDataFilter, vtkTriangleFilter,
                                           vtkWindowedSincPolyDataFilter)
except ImportError as missing:
    print(f"skipped: VTK for Python is missing ({missing})")
    sys.exit(77)

RADIUS, SIZE, COLUMNS, ROWS = 50.0, 5.0, 20, 16


def cylinder(i, j):
    return RADIUS * math.cos(i * SIZE / RADIUS), RADIUS * math.sin(i * SIZE / RADIUS), j * SIZE


def off_cylinder(p):
    return abs(math.hypot(p[0], p[1]) - RADIUS)


SLOPE = math.radians(20)


def cone(i, j):
    radius = RADIUS + j * SIZE * math.sin(SLOPE)
    return radius * math.cos(i * SIZE / RADIUS), radius * math.sin(i * SIZE / RADIUS), j * SIZE * math.cos(SLOPE)


def off_cone(p):
    return abs((math.hypot(p[0], p[1]) - RADIUS) * math.cos(SLOPE) - p[2] * math.sin(SLOPE))


AROUND = 120.0


def torus(i, j):
    turn, angle = (i - 10) * SIZE / RADIUS, j * SIZE / AROUND
    radius = AROUND + RADIUS * math.cos(turn)
    return radius * math.cos(angle), radius * math.sin(angle), RADIUS * math.sin(turn)


def off_torus(p):
    return abs(math.hypot(math.hypot(p[0], p[1]) - AROUND, p[2]) - RADIUS)


def jittered(place):
    """Nodes and quads; the inner nodes moved in the surface by up to 0.4 of an element."""
    chance = random.Random(1)
    points, quads = [], []
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            inside = 0 < i < COLUMNS and 0 < j < ROWS
            points.append(place(i + (chance.uniform(-0.4, 0.4) if inside else 0), j + (chance.uniform(-0.4, 0.4) if inside else 0)))
    for j in range(ROWS):
        for i in range(COLUMNS):
            a = j * (COLUMNS + 1) + i
            quads.append((a, a + 1, a + COLUMNS + 2, a + COLUMNS + 1))
    return points, quads


def write_deck(path, points, shells):
    lines = ["*KEYWORD", "*NODE"]
    lines += [f"{n + 1:8d}{p[0]:16.9f}{p[1]:16.9f}{p[2]:16.9f}" for n, p in enumerate(points)]
    lines.append("*ELEMENT_SHELL")
    for s, shell in enumerate(shells):
        corners = list(shell) + [shell[-1]] * (4 - len(shell))
        lines.append(f"{s + 1:8d}{1:8d}" + "".join(f"{c + 1:8d}" for c in corners))
    lines += ["*PART", "part", f"{1:10d}{1:10d}{1:10d}", "*SECTION_SHELL", f"{1:10d}{2:10d}", f"{1.0:10.1f}" * 4, "*MAT_ELASTIC",
              f"{1:10d}{'7.85E-9':>10}{'2.1E5':>10}{0.3:10.1f}", "*END", ""]
    path.write_text("\n".join(lines))


def read_points(path):
    points, inside = [], False
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            inside = line.startswith("*NODE")
        elif inside and not line.startswith("$"):
            points.append([float(line[8 + 16 * k:24 + 16 * k]) for k in range(3)])
    return points


def mesh_of(points, shells):
    mesh, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(point)
    for shell in shells:
        cells.InsertNextCell(len(shell))
        for corner in shell:
            cells.InsertCellPoint(corner)
    mesh.SetPoints(places)
    mesh.SetPolys(cells)
    return mesh


def places_of(filter):
    filter.Update()
    places = filter.GetOutput().GetPoints()
    return [places.GetPoint(n) for n in range(places.GetNumberOfPoints())]


def laplacian(points, shells, rounds):
    smooth = vtkSmoothPolyDataFilter()
    smooth.SetInputData(mesh_of(points, shells))
    smooth.SetNumberOfIterations(rounds)
    smooth.SetRelaxationFactor(0.1)
    smooth.SetOutputPointsPrecision(1)
    return places_of(smooth)


def windowed_sinc(points, shells):
    smooth = vtkWindowedSincPolyDataFilter()
    smooth.SetInputData(mesh_of(points, shells))
    smooth.SetNumberOfIterations(20)
    smooth.SetPassBand(0.1)
    smooth.NormalizeCoordinatesOn()
    return places_of(smooth)


def relaxed(program, folder, size):
    run = subprocess.run([program, "edit", folder / "before.k", "--target-size", str(size), "--edit", '{"edit": "relax", "scope": "all"}', "-o",
                          folder / "relaxed.k"], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"prismesh edit failed: {run.stderr}{run.stdout}")
    return read_points(folder / "relaxed.k")


def report_on(program, path, *options):
    run = subprocess.run([program, "check", path, "--json", *options], capture_output=True, text=True)
    return json.loads(run.stdout)


def quality(program, path, size):
    report = report_on(program, path, "--target-size", str(size))
    return report["composite"]["mean"], report["composite"]["min"], report["fail"]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def normal_of(corners):
    u, v = ([b - a for a, b in zip(corners[0], corners[2])], [b - a for a, b in zip(corners[1], corners[-1])])
    normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(dot(normal, normal))
    return tuple(x / length for x in normal) if length > 0 else normal


def real_part(models):
    """A real part of which every third node inside its sheets was moved in the surface, and how far places are from its facets."""
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "checker"))
    import check_deck
    main = json.loads((models / "counts.json").read_text())["bumper_beam_rad"]["main"]
    deck = check_deck.read(models / main)
    ids = sorted({n for e in deck.elements if e.cls == "shell" for n in e.nodes})
    number = {node: n for n, node in enumerate(ids)}
    points = [tuple(deck.nodes[node].basic()) for node in ids]
    shells = []
    for element in deck.elements:
        if element.cls == "shell":
            corners = [number[n] for n in element.nodes]
            shells.append(tuple(dict.fromkeys(corners)))
    triangles = vtkTriangleFilter()
    triangles.SetInputData(mesh_of(points, shells))
    triangles.Update()
    facets = vtkImplicitPolyDataDistance()
    facets.SetInput(triangles.GetOutput())

    def off(p):
        return abs(facets.EvaluateFunction(p))

    at_edge = {}
    for n, shell in enumerate(shells):
        for k, corner in enumerate(shell):
            at_edge.setdefault(tuple(sorted((shell[k - 1], corner))), []).append(n)
    normals = [normal_of([points[corner] for corner in shell]) for shell in shells]

    def is_feature(at):
        return len(at) != 2 or abs(dot(normals[at[0]], normals[at[1]])) < math.cos(math.radians(30))
    feature_nodes = {node for edge, at in at_edge.items() if is_feature(at) for node in edge}
    chance, moved = random.Random(1), list(points)
    neighbour = {}
    for a, b in at_edge:
        neighbour.setdefault(a, b)
        neighbour.setdefault(b, a)
    for n in range(0, len(points), 3):
        if n in feature_nodes:
            continue
        share, closest = chance.uniform(-0.35, 0.35), [0.0, 0.0, 0.0]
        facets.EvaluateFunctionAndGetClosestPoint([a + share * (b - a) for a, b in zip(points[n], points[neighbour[n]])], closest)
        moved[n] = tuple(closest)
    return moved, shells, off


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program, models = sys.argv[1], pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    parts = [(name, *jittered(place), off, SIZE) for name, place, off in
             (("cylinder", cylinder, off_cylinder), ("cone", cone, off_cone), ("torus", torus, off_torus))]
    if models and (models / "counts.json").exists():
        parts.append(("bumper beam", *real_part(models), None))
    print("| part | smoothed by | composite mean | min | failing | off the surface: mean | max |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for name, points, shells, off, size in parts:
            write_deck(folder / "before.k", points, shells)
            size = size or report_on(program, folder / "before.k")["target_size"]
            for how, places in (("nothing", points), ("relaxing", relaxed(program, folder, size)),
                                ("Laplace, 20 rounds", laplacian(points, shells, 20)), ("Laplace, 100 rounds", laplacian(points, shells, 100)),
                                ("windowed sinc", windowed_sinc(points, shells))):
                write_deck(folder / "after.k", places, shells)
                mean, least, failing = quality(program, folder / "after.k", size)
                away = [off(p) for p in places]
                print(f"| {name} | {how} | {mean:.2f} | {least:.2f} | {failing} | {sum(away) / len(away) / size:.2%} | {max(away) / size:.2%} |")


if __name__ == "__main__":
    main()
