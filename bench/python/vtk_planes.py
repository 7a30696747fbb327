"""Cuts a mesh with VTK plane by plane, as interactive programs do: vtkPlaneCutter with its tree of spheres for the segments
of a plane, vtkCleanPolyData and vtkStripper to join them to rings.

usage: vtk_planes.py MESH HEIGHTS RESULT

"read" includes the tree.
"""

import json
import sys
import time

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkCleanPolyData, vtkPlaneCutter, vtkStripper
from vtkmodules.vtkIOGeometry import vtkSTLReader


def main(mesh, heights, result):
    with open(heights, encoding="utf-8") as lines:
        planes = [float(line) for line in lines]
    started = time.perf_counter()
    reader = vtkSTLReader()
    reader.SetFileName(mesh)
    reader.Update()
    plane = vtkPlane()
    plane.SetNormal(0, 0, 1)
    cutter = vtkPlaneCutter()
    cutter.SetPlane(plane)
    cutter.SetInputConnection(reader.GetOutputPort())
    plane.SetOrigin(0, 0, planes[0])
    cutter.Update()
    was_read = time.perf_counter()
    found = [rings(cutter, plane, z) for z in planes]
    sliced = time.perf_counter()
    with open(result, "w", encoding="utf-8") as file:
        json.dump({"seconds": {"read": was_read - started, "slice": sliced - was_read},
                   "layers": [measured(z, lines) for z, lines in zip(planes, found)]}, file)


def rings(cutter, plane, z):
    plane.SetOrigin(0, 0, z)
    cutter.Update()
    pieces = vtkAppendPolyData()
    blocks = cutter.GetOutputDataObject(0).NewIterator()
    while not blocks.IsDoneWithTraversal():
        pieces.AddInputData(blocks.GetCurrentDataObject())
        blocks.GoToNextItem()
    joined = vtkCleanPolyData()
    joined.SetInputConnection(pieces.GetOutputPort())
    joined.PointMergingOn()
    joined.SetTolerance(0)
    stripper = vtkStripper()
    stripper.SetInputConnection(joined.GetOutputPort())
    stripper.JoinContiguousSegmentsOn()
    stripper.SetMaximumLength(2**31 - 1)
    stripper.Update()
    return stripper.GetOutput()


def measured(z, lines):
    points = vtk_to_numpy(lines.GetPoints().GetData()).astype(float)
    offsets = vtk_to_numpy(lines.GetLines().GetOffsetsArray())
    members = vtk_to_numpy(lines.GetLines().GetConnectivityArray())
    length = 0.0
    for begin, end in zip(offsets[:-1], offsets[1:]):
        ring = points[members[begin:end]]
        length += float((((ring[1:] - ring[:-1]) ** 2).sum(axis=1) ** 0.5).sum())
    return {"z": z, "contours": len(offsets) - 1, "perimeter_mm": length}


if __name__ == "__main__":
    main(*sys.argv[1:])
