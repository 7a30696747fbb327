"""Lamella cuts triangle meshes into layers of closed contours.

    import lamella

    stack = lamella.slice("part.stl", layer_height=0.1)
    print(len(stack), "layers,", stack.volume, "mm3")
    for ring in stack[0]:          # (n, 2) arrays of x and y
        print(ring.min(axis=0), ring.max(axis=0))
    lamella.write("part.cli", stack)

Lengths are millimetres, heights are absolute z. A mesh is a file (a path, bytes or a file object), a pair of arrays
(vertices, faces), or an object such as a trimesh.Trimesh. Points of layers are NumPy arrays that refer to memory of
the library, without a copy. Invalid arguments raise a TypeError or a ValueError, other failures a lamella.Error. Defects
that do not prevent a result cause a lamella.DefectWarning.
"""

from ._checks import Comparison, LayerDifference, VectorVerification, Verification, compare, verify, verify_vectors
from ._errors import (
    CancelledError,
    DefectError,
    DefectWarning,
    Error,
    InputError,
    InternalError,
    LimitError,
    OutputError,
    UsageError,
)
from ._files import convert, layer_formats, mesh_formats, read, read_layers, write
from ._lamella import (
    ContourRule,
    Exposure,
    HatchRule,
    Layer,
    LayerStream,
    Mesh,
    ParameterSet,
    ScanFigures,
    ScanStrategy,
    SkinRule,
    Stack,
    SupportRule,
    __version__,
)
from ._meshes import DefectPlaces, Inspection, Intersection, SelfIntersections, inspect, mend, read_mesh
from ._methods import ContourDefect
from ._pixels import Voxels
from ._plates import Part
from ._printing import PrintCavity, PrintCheck, PrintIsland
from ._scanning import PyslmLayer, ScanLayer, ScanStream, scan, to_pyslm
from ._sections import Section, Slicer
from ._slicing import Engine, engines, iter_layers, slice
from ._voxels import voxels

__all__ = [
    "CancelledError",
    "Comparison",
    "ContourDefect",
    "ContourRule",
    "DefectError",
    "DefectPlaces",
    "DefectWarning",
    "Engine",
    "Error",
    "Exposure",
    "HatchRule",
    "InputError",
    "Inspection",
    "InternalError",
    "Intersection",
    "Layer",
    "LayerDifference",
    "LayerStream",
    "LimitError",
    "Mesh",
    "OutputError",
    "ParameterSet",
    "Part",
    "PrintCavity",
    "PrintCheck",
    "PrintIsland",
    "PyslmLayer",
    "ScanFigures",
    "ScanLayer",
    "ScanStrategy",
    "ScanStream",
    "Section",
    "SelfIntersections",
    "SkinRule",
    "Slicer",
    "Stack",
    "SupportRule",
    "UsageError",
    "VectorVerification",
    "Verification",
    "Voxels",
    "__version__",
    "compare",
    "convert",
    "engines",
    "inspect",
    "iter_layers",
    "layer_formats",
    "mend",
    "mesh_formats",
    "read",
    "read_layers",
    "read_mesh",
    "scan",
    "slice",
    "to_pyslm",
    "verify",
    "verify_vectors",
    "voxels",
    "write",
]
