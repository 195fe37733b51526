#!/usr/bin/env python3
"""Draws the sheet of render_bench's `path` with VTK, turning: what a picture costs there. Needs Debian's python3-vtk9 and a display
(xvfb-run will do); without it the script says so and ends with status 77. Usage: compare_drawing.py [QUADS_ALONG_A_SIDE ..]; default 100 316 1000."""
import math
import resource
import statistics
import sys
import time

try:
    import vtk
except ImportError as missing:
    print(f"skipped: VTK for Python is missing ({missing})")
    sys.exit(77)

WIDTH, HEIGHT, PICTURES = 1920, 1080, 20


def sheet(side):
    points = vtk.vtkPoints()
    for j in range(side + 1):
        for i in range(side + 1):
            u, v = i / side, j / side
            points.InsertNextPoint(5000 * u, 5000 * v, 300 * math.sin(6 * u) * math.cos(5 * v))
    cells = vtk.vtkCellArray()
    for j in range(side):
        for i in range(side):
            a = j * (side + 1) + i
            cells.InsertNextCell(4, (a, a + 1, a + side + 2, a + side + 1))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def measure(side, edges):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(sheet(side))
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetEdgeVisibility(edges)
    renderer = vtk.vtkRenderer()
    renderer.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(WIDTH, HEIGHT)
    window.AddRenderer(renderer)
    window.Render()
    wall, before = [], time.process_time()
    for _ in range(PICTURES):
        renderer.GetActiveCamera().Azimuth(4.5)
        renderer.ResetCameraClippingRange()
        start = time.perf_counter()
        window.Render()
        window.WaitForCompletion()
        wall.append((time.perf_counter() - start) * 1000)
    cpu = (time.process_time() - before) * 1000 / PICTURES
    name = window.ReportCapabilities().split("OpenGL renderer string:")[1].split("\n")[0].strip()
    print(f"{side * side:9d} quads, {'with' if edges else 'without'} edges: {statistics.median(wall):7.1f} ms wall, {cpu:7.1f} ms processor, "
          f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024} MB   {name}", flush=True)


for quads in [int(text) for text in sys.argv[1:]] or [100, 316, 1000]:
    for with_edges in (False, True):
        measure(quads, with_edges)
