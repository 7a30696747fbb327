"""Conversion of objects to meshes, and inspection of meshes."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Iterable, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import PathLike, Progress
from ._errors import InputError, UsageError
from ._lamella import Mesh
from ._warning import warn

UPWARDS = (0, 0, 1)


class HasFaces(Protocol):
    """Anything with vertices and faces, such as a trimesh.Trimesh."""

    @property
    def vertices(self) -> Any:
        """Positions: (n, 3) numbers."""

    @property
    def faces(self) -> Any:
        """Indices of three rows of `vertices` for each triangle: (m, 3) whole numbers."""


MeshLike = Union[PathLike, Mesh, HasFaces, Tuple[npt.ArrayLike, npt.ArrayLike], npt.NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Inspection:
    """Findings of `inspect` about a mesh. Lengths are in millimetres. Defects are counted, not repaired."""

    path: str  #: the file; empty for arrays
    format: str  #: such as "stl-binary"; empty for arrays
    bounds: npt.NDArray[np.float64]  #: (2, 3): the smallest and the largest x, y and z
    triangles: int  #: as the file stores them
    vertices: int  #: number of different vertices
    volume: float  #: mm^3; meaningful when closed, negative when inside out
    area: float  #: mm^2, of all triangles
    closed: bool  #: slices have no open chains
    sound: bool  #: closed, and no defect was counted
    shells: int  #: components connected by edges
    cavities: int  #: closed shells that bound cavities in the material of others
    boundary_edges: int  #: edges with one triangle, at the rims of holes
    nonmanifold_edges: int  #: edges with more than two triangles
    orientation_conflicts: int  #: edges whose triangles do not run in opposite directions
    duplicate_triangles: int  #: further triangles with the same three vertices
    degenerate_triangles: int  #: with two equal corners
    inverted_shells: int  #: closed shells that are inside out

    @property
    def defects(self) -> str:
        """Returns the defects in words, such as "2 boundary edges, 1 inverted shell"; empty if there are none."""
        kinds = [(getattr(self, key), one, many) for key, one, many in _lamella.defect_kinds()]
        return ", ".join(f"{count} {one if count == 1 else many}" for count, one, many in kinds if count)


def read_mesh(
    path: PathLike,
    *,
    unit_mm: Optional[float] = None,
    strict: bool = False,
    include: Union[str, Iterable[str]] = (),
    max_triangles: int = 0,
    max_memory: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Mesh:
    mesh = _lamella.read_mesh(
        *check.reading(path, unit_mm, strict, include, max_triangles, max_memory, threads, progress)
    )
    warn(f"{mesh.path}: {warning}" for warning in mesh.warnings)
    return mesh


def arrays_of_mesh(vertices: Any, faces: Any) -> Tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    positions = check.shaped("vertices", vertices, (None, 3), "an array of numbers of the shape (n, 3)")
    expected = "an array of whole numbers of the shape (m, 3)"
    numbers = check.array("faces", faces, expected, kinds="iu")
    if numbers.ndim != 2 or numbers.shape[1] != 3:
        cut = "; faces of more than three corners must be cut into triangles first" if numbers.ndim == 2 else ""
        raise UsageError(f"faces: expected {expected}, found {check.described(numbers)}{cut}")
    if numbers.dtype == np.uint64 and (numbers > np.iinfo(np.int64).max).any():
        row, corner = np.argwhere(numbers > np.iinfo(np.int64).max)[0]
        raise InputError(
            f"faces: row {row} names vertex {numbers[row, corner]}, and there are {len(positions)}, counted from 0"
        )
    return positions, np.ascontiguousarray(numbers, dtype=np.int64)


def _mesh_of_triangles(name: str, corners: npt.NDArray[Any]) -> Mesh:
    """Makes a mesh of triangles without shared vertices: (m, 3, 3)."""
    if corners.ndim != 3 or corners.shape[1:] != (3, 3):
        raise UsageError(
            f"{name}: triangles: expected an array of the shape (m, 3, 3), found {check.described(corners)}; "
            "vertices and faces are given as a pair of arrays"
        )
    if len(corners) == 0:
        raise InputError(f"{name}: holds no triangle")
    positions = check.shaped(name, corners, (None, 3, 3), "an array of numbers of the shape (m, 3, 3)")
    unbounded = np.flatnonzero(~np.isfinite(positions).all(axis=(1, 2)))
    if len(unbounded):
        raise InputError(f"{name}: triangle {unbounded[0]} has a corner that is not finite")
    return Mesh(positions.reshape(-1, 3), np.arange(len(corners) * 3).reshape(-1, 3))


def as_mesh(name: str, part: Any, unit_mm: Optional[float] = None, **reading: Any) -> Mesh:
    """Returns a mesh made from any supported object. `reading` are further arguments of `read_mesh`, for paths."""
    if isinstance(part, (str, bytes, os.PathLike)):
        return read_mesh(check.path(name, part), unit_mm=unit_mm, **reading)
    if unit_mm is not None:
        raise UsageError("unit_mm goes with files: arrays and meshes are in millimetres; scale them by transform")
    if isinstance(part, Mesh):
        return part
    if isinstance(part, np.ndarray):
        return _mesh_of_triangles(name, part)
    if isinstance(part, (tuple, list)):
        if len(part) == 2:
            return Mesh(*part)
    elif hasattr(part, "vertices") and hasattr(part, "faces"):
        return Mesh(part.vertices, part.faces)
    raise TypeError(
        f"{name}: a mesh is a path, a lamella.Mesh, a pair of arrays (vertices, faces), or something with .vertices "
        f"and .faces; this is {check.described(part)}"
    )


Placing = Tuple[Tuple[float, ...], Optional[npt.NDArray[np.float64]]]


def placing(direction: Sequence[float], transform: Optional[npt.ArrayLike]) -> Placing:
    rows = None
    if transform is not None:
        rows = check.finite("transform", check.shaped("transform", transform, (4, 4), "a matrix of the shape (4, 4)"))
    return check.several("direction", direction, 3, "three numbers (x, y, z)", check.number), rows


def placed(mesh: Mesh, where: Placing, threads: int) -> Mesh:
    """Applies the transform, then rotates the mesh so that the direction points along z."""
    direction, transform = where
    if transform is not None:
        mesh = mesh._transformed(transform, threads)
    return mesh if direction == UPWARDS else mesh._rotated(direction, threads)


def inspect(
    part: MeshLike,
    *,
    unit_mm: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Inspection:
    """Counts the defects of a mesh. Nothing is repaired.

    part: a path, a Mesh, a pair of arrays (vertices (n, 3) in millimetres, faces (m, 3)), an array of triangles
        (m, 3, 3), or anything with .vertices and .faces, such as a trimesh.Trimesh.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises InputError for a file that cannot be read.
    """
    threads, progress = check.thread_count(threads), check.listener(progress)
    mesh = as_mesh("part", part, unit_mm=unit_mm, threads=threads, progress=progress)
    fields = mesh._defects(threads, progress)
    return Inspection(path=mesh.path, format=mesh.format, bounds=mesh.bounds, **fields)
