"""Meshes from whatever holds one, and what is wrong with them."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any, Callable, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _lamella
from ._errors import UsageError
from ._lamella import Mesh
from ._warning import warn

PathLike = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
Progress = Callable[[str, int, int], object]


class HasFaces(Protocol):
    """Anything with vertices and faces, such as a trimesh.Trimesh."""

    @property
    def vertices(self) -> Any:
        """Positions: (n, 3) numbers."""

    @property
    def faces(self) -> Any:
        """Three rows of `vertices` for each triangle: (m, 3) whole numbers."""


MeshLike = Union[PathLike, Mesh, HasFaces, Tuple[npt.ArrayLike, npt.ArrayLike], npt.NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Inspection:
    """What `inspect` finds in a mesh. Lengths are millimetres; defects are counted, never mended."""

    path: str  #: the file; empty for arrays
    format: str  #: such as "stl-binary"; empty for arrays
    bounds: npt.NDArray[np.float64]  #: (2, 3): the smallest and the largest x, y and z
    triangles: int  #: as the file stores them
    vertices: int  #: different ones
    volume: float  #: mm^3; meaningful when closed, negative when inside out
    area: float  #: mm^2, of all triangles
    closed: bool  #: slices have no open chains
    sound: bool  #: closed, and no defect was counted
    shells: int  #: parts connected over edges
    cavities: int  #: closed shells that are hollows in the material of others
    boundary_edges: int  #: with one triangle: rims of holes
    nonmanifold_edges: int  #: with more than two triangles
    orientation_conflicts: int  #: edges whose triangles do not run opposite ways
    duplicate_triangles: int  #: beyond the first with the same three vertices
    degenerate_triangles: int  #: with two equal corners
    inverted_shells: int  #: closed shells turned inside out

    @property
    def defects(self) -> str:
        """The defects in words, such as "2 boundary edges, 1 inverted shell"; empty where there is none."""
        kinds = [
            (self.boundary_edges, "boundary edge", "boundary edges"),
            (self.nonmanifold_edges, "edge with more than two triangles", "edges with more than two triangles"),
            (self.orientation_conflicts, "orientation conflict", "orientation conflicts"),
            (self.duplicate_triangles, "duplicate triangle", "duplicate triangles"),
            (self.degenerate_triangles, "degenerate triangle", "degenerate triangles"),
            (self.inverted_shells, "inverted shell", "inverted shells"),
        ]
        return ", ".join(f"{count} {one if count == 1 else many}" for count, one, many in kinds if count)


def is_path(thing: object) -> bool:
    return isinstance(thing, (str, bytes, os.PathLike))


def thread_count(threads: int) -> int:
    if threads < 0:
        raise UsageError(f"threads: {threads} is not possible; 0 takes one for each processor")
    return threads


def read_mesh(
    path: PathLike,
    *,
    label: str = "",
    unit_mm: Optional[float] = None,
    strict: bool = False,
    supports: bool = False,
    max_triangles: int = 0,
    max_memory: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Mesh:
    if unit_mm is not None and not (0 < unit_mm < math.inf):
        raise UsageError(f"unit_mm: {unit_mm} is not possible; a unit is a number of millimetres above 0")
    mesh = _lamella.read_mesh(
        os.fsencode(path), label, unit_mm, strict, supports, max_triangles, max_memory, thread_count(threads), progress
    )
    warn(f"{mesh.path}: {warning}" for warning in mesh.warnings)
    return mesh


def mesh_of_arrays(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> Mesh:
    positions = np.asarray(vertices)
    numbers = np.asarray(faces)
    if positions.ndim != 2 or positions.shape[1] != 3 or positions.dtype.kind not in "fiu":
        raise UsageError(f"vertices: expected an array of numbers of the shape (n, 3), found {_described(positions)}")
    if numbers.ndim != 2 or numbers.shape[1] != 3 or numbers.dtype.kind not in "iu":
        raise UsageError(
            f"faces: expected an array of whole numbers of the shape (m, 3), found {_described(numbers)}"
            + ("; faces of more than three corners must be cut into triangles first" if numbers.ndim == 2 else "")
        )
    return _lamella.mesh_of_arrays(positions, numbers)


def _described(array: npt.NDArray[Any]) -> str:
    return f"{array.shape} of {array.dtype}"


def _mesh_of_triangles(corners: npt.NDArray[Any]) -> Mesh:
    """Triangles that share nothing: (m, 3, 3)."""
    if corners.ndim != 3 or corners.shape[1:] != (3, 3):
        raise UsageError(
            f"triangles: expected an array of the shape (m, 3, 3), found {_described(corners)}; "
            "vertices and faces are given as a pair of arrays"
        )
    return mesh_of_arrays(corners.reshape(-1, 3), np.arange(len(corners) * 3).reshape(-1, 3))


def as_mesh(part: MeshLike, unit_mm: Optional[float] = None, **reading: Any) -> Mesh:
    """A mesh from whatever the user has. `reading` is for paths."""
    if isinstance(part, (str, bytes, os.PathLike)):
        return read_mesh(part, unit_mm=unit_mm, **reading)
    if unit_mm is not None:
        raise UsageError("unit_mm goes with files: arrays and meshes are in millimetres; scale them by transform")
    if isinstance(part, Mesh):
        return part
    if isinstance(part, np.ndarray):
        return _mesh_of_triangles(part)
    if isinstance(part, (tuple, list)):
        if len(part) == 2:
            return mesh_of_arrays(*part)
    elif hasattr(part, "vertices") and hasattr(part, "faces"):
        return mesh_of_arrays(part.vertices, part.faces)
    raise TypeError(
        "a mesh is a path, a lamella.Mesh, a pair of arrays (vertices, faces), or something with .vertices and "
        f".faces; this is a {type(part).__name__}"
    )


def placed(mesh: Mesh, direction: Sequence[float], transform: Optional[npt.ArrayLike]) -> Mesh:
    """First the transform, then `direction` turned upright."""
    if transform is not None:
        rows = np.asarray(transform, dtype=float)
        if rows.shape != (4, 4):
            raise UsageError(f"transform: expected a matrix of the shape (4, 4), found {rows.shape}")
        mesh = mesh._transformed(rows)
    towards = np.asarray(direction, dtype=float)
    if towards.shape != (3,):
        raise UsageError(f"direction: expected three numbers, found {towards.shape}")
    return mesh if tuple(towards) == (0, 0, 1) else mesh._turned(towards)


def inspect(
    part: MeshLike,
    *,
    unit_mm: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Inspection:
    """Counts what is wrong with a mesh. Nothing is mended.

    part: a path, a Mesh, a pair of arrays (vertices (n, 3) in millimetres, faces (m, 3)), an array of triangles
        (m, 3, 3), or anything with .vertices and .faces, such as a trimesh.Trimesh.
    unit_mm: millimetres per unit of a file that does not say its unit; 1 unless given.
    threads: 0 takes one for each processor.
    progress: called as progress(stage, done, total) now and then, from the thread that called this.

    Raises InputError for a file that cannot be read.
    """
    mesh = as_mesh(part, unit_mm=unit_mm, threads=threads, progress=progress)
    fields = mesh._defects(thread_count(threads), progress)
    return Inspection(path=mesh.path, format=mesh.format, bounds=mesh.bounds, **fields)
