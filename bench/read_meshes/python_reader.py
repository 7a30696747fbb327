"""Reads a mesh file with a library for Python; prints the seconds from file to mesh and the triangles, as JSON.

    python_reader.py LIBRARY FILE          LIBRARY: numpy-stl, meshio or vtk
    python_reader.py LIBRARY --version
"""

import importlib.metadata
import json
import sys
import time
from pathlib import Path


def numpy_stl():
    from stl import Mode, mesh

    def read(path):
        mode = Mode.ASCII if "ascii" in Path(path).name else Mode.BINARY
        return len(mesh.Mesh.from_file(path, mode=mode, calculate_normals=False).vectors)

    return importlib.metadata.version("numpy-stl"), read


def meshio():
    import meshio as library

    def read(path):
        return sum(len(block.data) for block in library.read(path).cells if block.type == "triangle")

    return library.__version__, read


def vtk():
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader

    def read(path):
        reader = {".stl": vtkSTLReader, ".obj": vtkOBJReader, ".ply": vtkPLYReader}[Path(path).suffix]()
        if isinstance(reader, vtkSTLReader):
            reader.MergingOff()
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput().GetNumberOfPolys()

    return vtkVersion.GetVTKVersion(), read


def main(arguments):
    version, read = {"numpy-stl": numpy_stl, "meshio": meshio, "vtk": vtk}[arguments[0]]()
    if arguments[1] == "--version":
        print(version)
        return
    start = time.perf_counter()
    triangles = read(arguments[1])
    print(json.dumps({"seconds": time.perf_counter() - start, "triangles": triangles}))


if __name__ == "__main__":
    main(sys.argv[1:])
