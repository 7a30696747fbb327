"""Measures how long a mesh takes to become voxels, by lamella.voxels and by VTK's vtkPolyDataToImageStencil.

    python3 -m bench.resin.voxels [options]      (from the root of the source tree; `make resin` does it)

The mesh is a torus with 1.5 million triangles and about 500 x 470 x 136 voxels of 0.1 mm. Both get it in memory, in
turn. VTK asks whether the middle of a voxel lies in the mesh; labels of Lamella, whether material takes half of its
section. So they may differ only in voxels that are partly covered, which is checked.
"""

import argparse
import json
import statistics
import sys
import time
from pathlib import Path

import numpy as np

SPACING = 0.1


def torus(around=1000, across=750, radius=18.2, tube=6.8):
    """Returns vertices and faces; an axis is a little shorter, so that no two are alike."""
    a, b = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    out = radius + tube * np.cos(b)
    vertices = np.stack([out * np.cos(a), 0.94 * out * np.sin(a), tube * np.sin(b)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    here, next_i = i * across + j, (i + 1) % around * across + j
    next_j, both = i * across + (j + 1) % across, (i + 1) % around * across + (j + 1) % across
    faces = np.concatenate([np.stack([here, next_i, both], -1).reshape(-1, 3), np.stack([here, both, next_j], -1).reshape(-1, 3)])
    return vertices, faces


def by_vtk(vertices, faces, origin, shape):
    """Returns a function that makes the voxels with VTK, or None if VTK is not installed."""
    try:
        from vtkmodules.util import numpy_support
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
        from vtkmodules.vtkImagingStencil import vtkImageStencilToImage, vtkPolyDataToImageStencil
    except ImportError:
        return None
    points = vtkPoints()
    points.SetData(numpy_support.numpy_to_vtk(vertices, deep=True))
    cells = vtkCellArray()
    cells.SetData(3, numpy_support.numpy_to_vtkIdTypeArray(faces.astype(np.int64).ravel(), deep=True))
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(cells)

    def make():
        stencil = vtkPolyDataToImageStencil()
        stencil.SetInputData(mesh)
        stencil.SetOutputOrigin(origin)
        stencil.SetOutputSpacing(SPACING, SPACING, SPACING)
        stencil.SetOutputWholeExtent(0, shape[2] - 1, 0, shape[1] - 1, 0, shape[0] - 1)
        image = vtkImageStencilToImage()
        image.SetInputConnection(stencil.GetOutputPort())
        image.SetInsideValue(1)
        image.SetOutsideValue(0)
        image.SetOutputScalarTypeToUnsignedChar()
        image.Update()
        return numpy_support.vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).reshape(shape)

    return make


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.resin.voxels", description=__doc__.splitlines()[0])
    parser.add_argument("--package", default="build/python", help="folder of the package (default: %(default)s)")
    parser.add_argument("--out", default="out/resin", help="folder of the report (default: %(default)s)")
    parser.add_argument("--rounds", type=int, default=9, help="runs of each (default: %(default)s)")
    options = parser.parse_args(arguments)
    sys.path.insert(0, options.package)
    import lamella

    vertices, faces = torus()
    mesh = lamella.Mesh(vertices, faces)
    found = lamella.voxels(mesh, SPACING)
    ways = {"lamella": lambda: lamella.voxels(mesh, SPACING).array}
    vtk = by_vtk(vertices, faces, found.origin, found.array.shape)
    if vtk is not None:
        ways["vtk"] = vtk
    seconds = {name: [] for name in ways}
    arrays = {}
    for _ in range(options.rounds):
        for name, make in ways.items():
            began = time.perf_counter()
            arrays[name] = make()
            seconds[name].append(time.perf_counter() - began)
    report = {"triangles": len(faces), "shape": list(found.array.shape),
              "seconds": {name: statistics.median(each) for name, each in seconds.items()}}
    if vtk is not None:
        coverage = lamella.voxels(mesh, SPACING, labels=False).array
        others = arrays["lamella"] != arrays["vtk"]
        wrong = int(np.count_nonzero(others & ((coverage == 0) | (coverage == 255))))
        report |= {"different": int(np.count_nonzero(others)), "partly covered": int(np.count_nonzero((coverage > 0) & (coverage < 255))),
                   "ratio": report["seconds"]["vtk"] / report["seconds"]["lamella"]}
        if wrong:
            sys.exit(f"{wrong} voxels differ although material covers them entirely or not at all")
    Path(options.out).mkdir(parents=True, exist_ok=True)
    (Path(options.out) / "voxels.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(report))


if __name__ == "__main__":
    main(sys.argv[1:])
