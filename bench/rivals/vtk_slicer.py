"""Cuts a mesh with VTK: vtkCutter for the segments of all planes, vtkStripper to join them to rings.

usage: vtk_slicer.py MESH HEIGHTS RESULT
       vtk_slicer.py --version
"""

import json
import math
import sys
import time


def main(mesh, heights, result):
    from vtkmodules.vtkFiltersCore import vtkCutter, vtkStripper
    from vtkmodules.vtkIOGeometry import vtkSTLReader
    from vtkmodules.vtkCommonDataModel import vtkPlane

    with open(heights, encoding="utf-8") as lines:
        planes = [float(line) for line in lines]
    started = time.perf_counter()
    reader = vtkSTLReader()
    reader.SetFileName(mesh)
    reader.Update()
    read = time.perf_counter()

    plane = vtkPlane()
    plane.SetNormal(0, 0, 1)
    plane.SetOrigin(0, 0, 0)
    cutter = vtkCutter()
    cutter.SetCutFunction(plane)
    cutter.SetInputConnection(reader.GetOutputPort())
    for i, z in enumerate(planes):
        cutter.SetValue(i, z)
    stripper = vtkStripper()
    stripper.SetInputConnection(cutter.GetOutputPort())
    stripper.JoinContiguousSegmentsOn()
    stripper.SetMaximumLength(2**31 - 1)
    stripper.Update()
    sliced = time.perf_counter()

    with open(result, "w", encoding="utf-8") as file:
        json.dump({"seconds": {"read": read - started, "slice": sliced - read},
                   "layers": layers(stripper.GetOutput(), planes)}, file)


def layers(lines, planes):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(lines.GetPoints().GetData())
    offsets = vtk_to_numpy(lines.GetLines().GetOffsetsArray())
    members = vtk_to_numpy(lines.GetLines().GetConnectivityArray())
    found = [{"z": z, "contours": 0, "perimeter_mm": 0.0} for z in planes]
    order = sorted(range(len(planes)), key=planes.__getitem__)
    step = (planes[-1] - planes[0]) / max(len(planes) - 1, 1) or 1.0
    for begin, end in zip(offsets[:-1], offsets[1:]):
        ring = points[members[begin:end]].astype(float)
        layer = found[order[min(max(round((ring[0][2] - planes[0]) / step), 0), len(planes) - 1)]]
        layer["contours"] += 1
        ends = ring[1:] - ring[:-1]
        layer["perimeter_mm"] += float(((ends * ends).sum(axis=1) ** 0.5).sum())
    return found


def version():
    from vtkmodules.vtkCommonCore import vtkVersion

    return vtkVersion.GetVTKVersion()


if __name__ == "__main__":
    if sys.argv[1:] == ["--version"]:
        print(version())
    elif len(sys.argv) == 4:
        main(*sys.argv[1:])
    else:
        sys.exit(__doc__)
