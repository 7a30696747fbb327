"""Conversion of objects to meshes, and inspection of meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, List, Literal, NamedTuple, Optional, Protocol, Tuple, TypedDict, Union

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import Positive, Progress, Readable, Threads, Words
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


class HasTriangles(Protocol):
    """Anything with vertices and triangles, such as an open3d.geometry.TriangleMesh."""

    @property
    def vertices(self) -> Any:
        """Positions: (n, 3) numbers."""

    @property
    def triangles(self) -> Any:
        """Indices of three rows of `vertices` for each triangle: (m, 3) whole numbers."""


class HasPoints(Protocol):
    """Anything with points and faces, such as a pyvista.PolyData."""

    @property
    def points(self) -> Any:
        """Positions: (n, 3) numbers."""

    @property
    def faces(self) -> Any:
        """Whole numbers, for each triangle 3 and the indices of three rows of `points`: (4 m,)."""


class HasCells(Protocol):
    """Anything with points and cells by their type, such as a meshio.Mesh."""

    @property
    def points(self) -> Any:
        """Positions: (n, 3) numbers."""

    @property
    def cells_dict(self) -> Any:
        """Indices of rows of `points` for each cell; those of the type "triangle" are used: (m, 3) whole numbers."""


class HasVectors(Protocol):
    """Anything with the corners of triangles, such as a stl.mesh.Mesh of numpy-stl."""

    @property
    def vectors(self) -> Any:
        """Corners of triangles: (m, 3, 3) numbers."""


MeshLike = Union[
    Readable, Mesh, HasFaces, HasTriangles, HasPoints, HasCells, HasVectors, Tuple[npt.ArrayLike, npt.ArrayLike], npt.NDArray[Any]
]


class Intersection(NamedTuple):
    """Two triangles that intersect beyond the vertices and the edge that they share."""

    kind: Literal["crossing", "overlapping", "touching"]
    triangles: Tuple[int, int]  #: rows of Mesh.faces
    at: Tuple[float, float, float]  #: approximately, in millimetres


class SelfIntersections(NamedTuple):
    """Pairs of triangles that intersect. The counts are complete. It is true if there are any."""

    crossing: int  #: pairs of triangles that pass through each other
    overlapping: int  #: pairs that lie upon one another in one plane
    touching: int  #: pairs that meet beside their edges
    flat_triangles: int  #: triangles without area, which are ignored
    first: List[Intersection]  #: the first that cross or overlap, then the first that touch

    def __bool__(self) -> bool:
        return self.crossing + self.overlapping + self.touching > 0


class DefectPlaces(TypedDict):
    """Where the first defects of each kind are, in millimetres."""

    boundary_loops: List[npt.NDArray[np.float64]]  #: the rims of holes, the longest first, each (n, 3)
    nonmanifold_edges: npt.NDArray[np.float64]  #: (n, 2, 3)
    orientation_conflicts: npt.NDArray[np.float64]  #: (n, 2, 3): edges
    nonmanifold_vertices: npt.NDArray[np.float64]  #: (n, 3): where parts of the surface touch
    inverted_shells: npt.NDArray[np.float64]  #: (n, 2, 3): their bounds
    duplicate_triangles: List[int]  #: rows of Mesh.faces
    degenerate_triangles: List[int]  #: rows of Mesh.faces


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
    places: DefectPlaces  #: where the first defects of each kind are
    self_intersections: Optional[SelfIntersections]  #: None if they were not searched for

    @property
    def defects(self) -> str:
        """Returns the defects in words, such as "2 boundary edges, 1 inverted shell"; empty if there are none."""
        kinds = [(getattr(self, key), one, many) for key, one, many in _lamella.defect_kinds()]
        return ", ".join(f"{count} {one if count == 1 else many}" for count, one, many in kinds if count)


@check.arguments
def read_mesh(
    file: Readable,
    *,
    unit_mm: Optional[Positive] = None,
    strict: bool = False,
    include: Words = (),
    max_triangles: int = 0,
    max_memory: int = 0,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Mesh:
    """Reads a mesh file; the content determines the format.

    file: a path, bytes, or a file object that is open for reading bytes; see `read`. Formats: see `mesh_formats`. Each
        may be compressed with gzip.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default.
    strict: raises a DefectError instead of issuing a DefectWarning.
    include: one or several of the words "support", "negative", "modifier", "support-blocker", "support-enforcer",
        "surface" and "other". Objects to which a 3MF or AMF file gives one of these roles are then read as solids, too.
        By default negative volumes are subtracted when the mesh is sliced, and a DefectWarning counts the other objects
        that were left out. In slice files supports are parts like others; see Stack.support.
    max_triangles: largest number of triangles; otherwise a LimitError is raised. 0 permits any number.
    max_memory, threads, progress: as for `read`.

    Raises InputError for a file without a mesh, and LimitError.
    """
    return _mesh_of_file("file", file, unit_mm, strict, include, max_triangles, max_memory, threads, progress)


def _mesh_of_file(name: str, file: Any, *reading: Any) -> Mesh:
    mesh = _lamella.read_mesh(check.source(name, file), *reading)
    warn(f"{mesh.path}: {warning}" for warning in mesh.warnings)
    return mesh


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


def _attribute(thing: Any, name: str) -> Any:
    """Returns an attribute, or None if there is none or it cannot be had, such as faces of one size."""
    try:
        return getattr(thing, name, None)
    except Exception:
        return None


def _arrays_of(name: str, thing: Any) -> Optional[Tuple[Any, Any]]:
    """Returns vertices and faces of an object that has them by any of the usual names."""
    for positions, triangles in ("vertices", "faces"), ("vertices", "triangles"), ("points", "regular_faces"):
        found = _attribute(thing, positions), _attribute(thing, triangles)
        if found[0] is not None and found[1] is not None:
            return found
    points, faces, cells = (_attribute(thing, one) for one in ("points", "faces", "cells_dict"))
    if points is not None and faces is not None:
        return points, _without_counts(name, faces)
    if points is not None and cells is not None:
        return points, _triangles_of_cells(name, cells)
    vectors = _attribute(thing, "vectors")
    if vectors is not None and np.shape(vectors)[1:] == (3, 3):
        corners = np.asarray(vectors)
        return corners.reshape(-1, 3), np.arange(len(corners) * 3).reshape(-1, 3)
    return _arrays_of_vtk(name, thing)


def _triangles_of_cells(name: str, cells: Any) -> Any:
    """Returns the triangles of a dict of cells by their type. Lines and vertices bound no solid and are ignored."""
    others = sorted(check.excerpt(kind) for kind in cells if kind not in ("triangle", "line", "vertex"))
    if others or "triangle" not in cells:
        raise UsageError(
            f"{name}: cells: expected triangles, found {', '.join(others) or 'none'}; take the triangles of the surface alone"
        )
    return cells["triangle"]


def _arrays_of_vtk(name: str, thing: Any) -> Optional[Tuple[Any, Any]]:
    """Returns points and triangles of a vtkPolyData; None for anything else."""
    if not all(callable(_attribute(thing, method)) for method in ("GetPoints", "GetPolys", "GetNumberOfStrips")):
        return None
    from vtkmodules.util.numpy_support import vtk_to_numpy  # type: ignore  # it has no types

    polygons = thing.GetPolys()
    corners = vtk_to_numpy(polygons.GetConnectivityArray())
    if thing.GetNumberOfStrips() or len(corners) != 3 * polygons.GetNumberOfCells() or polygons.GetMaxCellSize() > 3:
        raise UsageError(f"{name}: faces of more than three corners and strips must be cut into triangles first (vtkTriangleFilter)")
    points = thing.GetPoints()
    if points is None:
        raise InputError(f"{name}: holds no triangle")
    return vtk_to_numpy(points.GetData()), corners.reshape(-1, 3)


def _without_counts(name: str, faces: Any) -> Any:
    """Returns the rows of a flat array in which each face begins with the number of its corners."""
    flat = check.array(f"{name}: faces", faces, "an array of whole numbers", kinds="iu")
    if flat.ndim != 1:
        return flat
    if len(flat) % 4 or (flat[::4] != 3).any():
        raise UsageError(
            f"{name}: faces: expected 3 before the corners of each triangle; faces of more than three corners must be cut "
            "into triangles first"
        )
    return flat.reshape(-1, 4)[:, 1:]


def is_mesh(thing: Any) -> bool:
    """Returns whether an object, which is not a file, is meant as a mesh."""
    if isinstance(thing, (tuple, list)):
        return len(thing) == 2 and all(isinstance(array, (tuple, list)) or hasattr(array, "__array__") for array in thing)
    return isinstance(thing, (Mesh, np.ndarray)) or _arrays_of("part", thing) is not None


def as_mesh(
    name: str,
    part: Any,
    unit_mm: Optional[float] = None,
    strict: bool = False,
    max_memory: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Mesh:
    """Returns a mesh made from any supported object. The other arguments are for files."""
    if check.is_file(part):
        return _mesh_of_file(name, part, unit_mm, strict, "", 0, max_memory, threads, progress)
    if unit_mm is not None:
        raise UsageError("unit_mm goes with files: arrays and meshes are in millimetres; scale them")
    if isinstance(part, Mesh):
        return part
    if isinstance(part, np.ndarray):
        return _mesh_of_triangles(name, part)
    if isinstance(part, (tuple, list)):
        if any(check.is_file(one) or isinstance(one, Mesh) or _arrays_of(name, one) is not None for one in part):
            raise TypeError(f"{name}: several meshes make up a plate: put each of them into a lamella.Part")
        if len(part) == 2:
            return Mesh(*part)
    elif (arrays := _arrays_of(name, part)) is not None:
        return Mesh(*arrays)
    raise TypeError(
        f"{name}: a mesh is a path, bytes, a binary file, a lamella.Mesh, a pair of arrays (vertices, faces), or something "
        f"with .vertices and .faces; this is {check.described(part)}"
    )


# The direction and the transform.
Placing = Tuple[Tuple[float, ...], Optional[npt.NDArray[np.float64]]]


def placed(mesh: Mesh, where: Placing, threads: int) -> Mesh:
    """Applies the transform, then rotates the mesh so that the direction points along z."""
    direction, transform = where
    if transform is not None:
        mesh = mesh._transformed(transform, threads)
    return mesh if direction == UPWARDS else mesh._rotated(direction, threads)


# The weld tolerance, whether duplicates are dropped, and whether triangles are oriented.
Mending = Tuple[Optional[float], bool, bool]


@check.arguments
def mend(
    part: MeshLike,
    *,
    weld_tolerance: Optional[Positive] = None,
    drop_duplicates: bool = False,
    orient: bool = False,
    unit_mm: Optional[Positive] = None,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Mesh:
    """Returns a repaired mesh, whose `repairs` has the counts. Slicing it gives the layers that `slice` gives with the
    same repairs. The bodies of a 3MF or AMF file are repaired one by one.

    part: a path, bytes, a file object, or another mesh, as for `slice`.
    weld_tolerance, drop_duplicates, orient: as for `slice`, in this order. At least one is required.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises UsageError, InputError if nothing is left of the mesh, LimitError.
    """
    wanted = (weld_tolerance, drop_duplicates, orient)
    if not any(wanted):
        raise UsageError("mend: expected weld_tolerance, drop_duplicates or orient")
    return as_mesh("part", part, unit_mm, False, 0, threads, progress)._mended(wanted, threads, progress)


@check.arguments
def inspect(
    part: MeshLike,
    *,
    self_intersections: bool = False,
    keep: int = 16,
    unit_mm: Optional[Positive] = None,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Inspection:
    """Counts the defects of a mesh, and reports where they are. Nothing is repaired.

    part: a path, bytes, a file object, or another mesh, as for `slice`.
    self_intersections: looks for triangles that cross, overlap or touch one another, too, which takes longer.
    keep: largest number of locations of each kind; the counts are complete.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises InputError for a file that cannot be read.
    """
    mesh = as_mesh("part", part, unit_mm, False, 0, threads, progress)
    fields = mesh._diagnosed(self_intersections, keep, threads, progress)
    met = fields["self_intersections"]
    if met is not None:
        crossing, overlapping, touching, flat, first = met
        found = [Intersection(*one) for one in first]
        fields["self_intersections"] = SelfIntersections(crossing, overlapping, touching, flat, found)
    return Inspection(path=mesh.path, format=mesh.format, bounds=mesh.bounds, **fields)
