"""Cuts a mesh with the Python package.

usage: lamella_slicer.py file|arrays|planes MESH HEIGHTS RESULT

`file` reads the file by the package; `arrays` passes vertices and faces, as from a mesh in NumPy; `planes` cuts one plane
after the other with a Slicer, which "read" includes.
"""

import json
import sys
import time

import numpy as np

import lamella


def main(way, mesh, heights, result):
    planes = np.loadtxt(heights, ndmin=1)
    if way == "arrays":
        read = lamella.read(mesh)
        arrays = np.array(read.vertices), np.array(read.faces)
    started = time.perf_counter()
    part = arrays if way == "arrays" else lamella.read(mesh)
    slicer = lamella.Slicer(part) if way == "planes" else None
    was_read = time.perf_counter()
    before = time.process_time()
    stack = [slicer.section(z) for z in planes] if slicer else lamella.slice(part, z=planes)
    processor = time.process_time() - before
    sliced = time.perf_counter()
    with open(result, "w", encoding="utf-8") as file:
        json.dump({"seconds": {"read": was_read - started, "slice": sliced - was_read}, "processor_seconds": processor,
                   "layers": [{"z": layer.z, "contours": len(layer), "area_mm2": layer.area,
                               "perimeter_mm": layer.perimeter} for layer in stack]}, file)


if __name__ == "__main__":
    main(*sys.argv[1:])
