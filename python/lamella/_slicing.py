"""Slicing of meshes."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import FILL_RULES, CutAt, FillRule, Progress, Vector
from ._errors import DefectError, UsageError
from ._lamella import LayerStream, Stack
from ._meshes import mending, placing
from ._plates import Sliceable, plate_of
from ._warning import warn, with_arguments

DEFAULT_LAYER_HEIGHT = 0.1
DEFAULT_CUSP = 0.05
LAST = 2**64 - 1  # an end above all layers
PLACES = ("bottom", "middle", "top")


class Engine(NamedTuple):
    """A slicing algorithm."""

    name: str  #: value for `engine=`
    summary: str  #: one line
    source: str  #: the publication it follows, or ""


def engines() -> List[Engine]:
    """Returns the available algorithms; the first is the default.

    For a mesh that is closed and consistently oriented, with two triangles at each edge, all give the same layers, with
    one exception: "conventional" may be wrong where contours touch in a point.
    """
    return [Engine(*row) for row in _lamella.engines()]


@check.suggesting
def slice(
    part: Sliceable,
    layer_height: Optional[float] = None,
    *,
    z: Optional[npt.ArrayLike] = None,
    offsets: Optional[npt.ArrayLike] = None,
    heights: Union[None, Sequence[Tuple[float, float, float]], npt.NDArray[Any]] = None,
    adaptive: Optional[Tuple[float, float]] = None,
    cusp: Optional[float] = None,
    first_layer_height: Optional[float] = None,
    at: CutAt = "middle",
    z_range: Optional[Tuple[float, float]] = None,
    layers: Optional[Tuple[int, Optional[int]]] = None,
    snap: float = 0,
    direction: Vector = (0, 0, 1),
    transform: Optional[npt.ArrayLike] = None,
    unit_mm: Optional[float] = None,
    weld_tolerance: Optional[float] = None,
    drop_duplicates: bool = False,
    orient: bool = False,
    close_gaps: Optional[float] = None,
    fill: Optional[FillRule] = None,
    engine: str = "sweep",
    strict: bool = False,
    max_memory: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Stack:
    """Cuts a mesh into layers of closed contours.

    part: a path, bytes, or a file object that is open for reading bytes; a Mesh, a pair of arrays (vertices (n, 3) in
        millimetres, faces (m, 3)), an array of triangles (m, 3, 3), or anything with .vertices and .faces, .vertices and
        .triangles, .points and .faces, .points and .cells_dict, or .vectors, such as a trimesh.Trimesh, a mesh of Open3D,
        PyVista, meshio or numpy-stl, or a vtkPolyData.
        A Part, or a list of them, is a plate: all parts are cut at the same heights, and stay apart in Stack.parts and
        Layer.parts.
    layer_height: thickness of a layer in millimetres, stacked from the bottom of the part; 0.1 by default.

    Instead of one layer height:
    z: one height, or ascending heights, in millimetres, (layers,); the mesh is cut exactly there.
    offsets: the same, relative to the bottom of the part.
    heights: ranges (from, to, layer_height) in millimetres above the bottom of the part; elsewhere layers are
        `layer_height` high.
    adaptive: the smallest and the largest layer height. Layers are as high as the slopes of the surface allow, so that
        their steps deviate from it by at most `cusp` millimetres, 0.05 by default.

    first_layer_height: thickness of the first layer in millimetres, if it differs.
    at: position of the cut within a layer: "bottom", "middle" or "top".
    z_range: keeps only the layers that are cut between these two heights, in millimetres, both included.
    layers: keeps only the layers with indices from the first of these numbers to the one before the second; (2, None) keeps
        all from 2 on.
    snap: vertices at most this far from a plane, in millimetres, count as on it. It is meant for faces that are
        horizontal except for rounding.
    direction: the direction of slicing, (x, y, z) of any length; the mesh is rotated so that this points along z.
    transform: a (4, 4) matrix in millimetres that is applied to the mesh, or to the whole plate, before this rotation.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default. A Part has its own.

    Nothing is mended unless you ask for it; `repairs` of the result has the counts. In this order:
    weld_tolerance: joins vertices that are at most this far apart, in millimetres, the closest pairs first.
    drop_duplicates: of triangles with the same corners keeps one; those that run in opposite directions cancel in pairs.
    orient: flips triangles so that neighbours agree, and shells outward, or inward where they are voids.
    close_gaps: joins ends of open contours that are at most this far apart, in millimetres, the closest first.
    fill: unites contours that overlap. Material is where the winding number satisfies this rule: "nonzero", "evenodd" or
        "positive".

    engine: the algorithm, one of `engines`.
    strict: raises a DefectError for any defect of the file or its mesh.
    max_memory: largest number of bytes that reading a file and the list of layers may take; otherwise a LimitError is
        raised. 0 means three quarters of the memory of the machine for the file, and 1 GiB for the list of layers: about
        2 million layers.
    threads: number of threads; 0 means one for each processor. The result is the same, bit for bit, for any number.
    progress: called as progress(stage, done, total) from time to time, on the calling thread. The stages are "read",
        "weld", "link" and "slice"; `done` and `total` count bytes, triangles or layers. An exception that it raises
        stops slicing and reaches the caller.

    Other Python threads can run in the meantime. Ctrl-C stops slicing within a second.

    Raises UsageError, InputError, DefectError, LimitError. Issues a DefectWarning if the file has defects, if contours
    do not close because the mesh has holes, if rings bound no material because triangles face inwards, or if horizontal
    faces coincide with a plane except for rounding, which then decides the content of the layer.
    """
    plate, plan = _prepared(
        part, layer_height, z, offsets, heights, adaptive, cusp, first_layer_height, at, z_range, layers, snap,
        direction, transform, unit_mm, weld_tolerance, drop_duplicates, orient, close_gaps, fill, engine, strict, max_memory, threads, progress,
    )  # fmt: skip
    stack = _lamella.slice_stack(plate, plan, engine, threads, progress)
    doubts = _named(plate, _lamella.mesh_doubts(stack, plate))
    if strict and doubts:
        raise DefectError(with_arguments(doubts[0]))
    warn(doubts)
    return stack


@check.suggesting
def iter_layers(
    part: Sliceable,
    layer_height: Optional[float] = None,
    *,
    z: Optional[npt.ArrayLike] = None,
    offsets: Optional[npt.ArrayLike] = None,
    heights: Union[None, Sequence[Tuple[float, float, float]], npt.NDArray[Any]] = None,
    adaptive: Optional[Tuple[float, float]] = None,
    cusp: Optional[float] = None,
    first_layer_height: Optional[float] = None,
    at: CutAt = "middle",
    z_range: Optional[Tuple[float, float]] = None,
    layers: Optional[Tuple[int, Optional[int]]] = None,
    snap: float = 0,
    direction: Vector = (0, 0, 1),
    transform: Optional[npt.ArrayLike] = None,
    unit_mm: Optional[float] = None,
    weld_tolerance: Optional[float] = None,
    drop_duplicates: bool = False,
    orient: bool = False,
    close_gaps: Optional[float] = None,
    fill: Optional[FillRule] = None,
    engine: str = "sweep",
    strict: bool = False,
    max_memory: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> LayerStream:
    """Yields the layers of a mesh one by one, in ascending z, while the next ones are computed. This is for parts whose
    layers do not fit into memory: the number of layers that wait for the caller is bounded.

    Takes what `slice` takes and gives the same layers. The mesh is read before this function returns; later errors are
    raised by the iterator. To stop early, leave the loop, call close(), or use `with`.

    strict: inspects the mesh first. Otherwise there is no warning about open chains (see Layer.open_chains) and rings
        that bound no material.
    """
    plate, plan = _prepared(
        part, layer_height, z, offsets, heights, adaptive, cusp, first_layer_height, at, z_range, layers, snap,
        direction, transform, unit_mm, weld_tolerance, drop_duplicates, orient, close_gaps, fill, engine, strict, max_memory, threads, progress,
    )  # fmt: skip
    return _lamella.stream(plate, plan, engine, threads, progress)


def _named(plate: _lamella.Plate, texts: List[Tuple[int, str]]) -> List[str]:
    return [f"{plate.names[file]}: {text}" for file, text in texts]


def _prepared(
    part: Sliceable,
    layer_height: Optional[float],
    z: Optional[npt.ArrayLike],
    offsets: Optional[npt.ArrayLike],
    heights: Union[None, Sequence[Tuple[float, float, float]], npt.NDArray[Any]],
    adaptive: Optional[Tuple[float, float]],
    cusp: Optional[float],
    first_layer_height: Optional[float],
    at: str,
    z_range: Optional[Tuple[float, float]],
    layers: Optional[Tuple[int, Optional[int]]],
    snap: float,
    direction: Vector,
    transform: Optional[npt.ArrayLike],
    unit_mm: Optional[float],
    weld_tolerance: Optional[float],
    drop_duplicates: bool,
    orient: bool,
    close_gaps: Optional[float],
    fill: Optional[str],
    engine: str,
    strict: bool,
    max_memory: int,
    threads: int,
    progress: Optional[Progress],
) -> Tuple[_lamella.Plate, _lamella.Plan]:
    """Returns the plate, and the plan by which it is cut."""
    _check_conflicts(layer_height, z, offsets, heights, adaptive, cusp, first_layer_height)
    check.choice("engine", engine, [known.name for known in engines()])
    threads, progress = check.thread_count(threads), check.listener(progress)
    whole = placing(direction, transform)
    strict = check.flag("strict", strict)
    max_memory = check.whole("max_memory", max_memory)
    above_bottom = check.optional(_heights, "offsets", offsets)
    cuts = check.optional(_heights, "z", z)
    ranges = check.optional(_ranges, "heights", heights)
    varying = None
    if adaptive is not None:
        between = check.pair("adaptive", adaptive, "two numbers (smallest, largest)", check.positive)
        varying = (*between, check.positive("cusp", DEFAULT_CUSP if cusp is None else cusp))
    height = check.positive("layer_height", DEFAULT_LAYER_HEIGHT if layer_height is None else layer_height)
    first_height = check.optional(check.positive, "first_layer_height", first_layer_height)
    place = check.choice("at", at, PLACES)
    z_limits = None if z_range is None else check.pair("z_range", z_range, "two numbers (from, to)", check.number)
    numbers = check.optional(_index_range, "layers", layers)
    near = check.distance("snap", snap)
    repairs = mending(weld_tolerance, drop_duplicates, orient)
    close_gaps = check.optional(check.positive, "close_gaps", close_gaps)
    fill = check.optional(check.choice, "fill", fill, FILL_RULES)
    plate = plate_of(
        "part", part, unit_mm, whole, repairs, strict=strict, max_memory=max_memory, threads=threads, progress=progress
    )
    if above_bottom is not None:
        cuts = above_bottom + plate.bottom
    cut: Union[_lamella.UniformLayers, _lamella.ListedPlanes, _lamella.HeightRanges, _lamella.AdaptiveLayers]
    if cuts is not None:
        cut = _lamella.ListedPlanes(cuts)
    elif varying is not None:
        cut = _lamella.AdaptiveLayers(*varying)
    elif ranges is not None:
        cut = _lamella.HeightRanges(ranges, height)
    else:
        cut = _lamella.UniformLayers(height, first_height)
    plan = _lamella.plan(
        plate, cut, place, z_limits, numbers, near, close_gaps, fill or "none", max_memory, threads, progress
    )
    doubts = _named(plate, _lamella.near_faces(plate, plan, threads, progress))
    if strict and doubts:
        raise DefectError(with_arguments(doubts[0]))
    warn(doubts)
    return plate, plan


def _index_range(name: str, value: Any) -> Tuple[int, int]:
    def one(name: str, value: Any) -> Optional[int]:
        return check.optional(check.whole, name, value)

    first, end = check.pair(name, value, "two whole numbers (first, end)", one)
    return check.whole(name, first), LAST if end is None else end


def _heights(name: str, values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    array = check.array(name, values, "a list of numbers")
    if array.ndim == 0:
        array = array.reshape(1)
    if array.ndim != 1:
        raise UsageError(f"{name}: expected a list of numbers, found an array of the shape {array.shape}")
    if len(array) == 0:
        raise UsageError(f"{name}: expected a list of numbers, found an empty one")
    heights = check.finite(name, array.astype(np.float64))
    fallen = np.flatnonzero(np.diff(heights) <= 0)
    if len(fallen):
        before, after = heights[fallen[0] : fallen[0] + 2]
        raise UsageError(f"{name}: {after:g} is not above the one before it, {before:g}; the list must ascend")
    return heights


def _ranges(name: str, values: Any) -> Tuple[Tuple[float, ...], ...]:
    expected = "ranges, each of three numbers (from, to, layer_height)"

    def one(name: str, value: Any) -> Tuple[float, ...]:
        return check.several(name, value, 3, expected, check.number)

    found = check.several(name, values, None, expected, one)
    if not found:
        raise UsageError(f"{name}: expected {expected}, found none")
    return found


def _check_conflicts(
    layer_height: Any, z: Any, offsets: Any, heights: Any, adaptive: Any, cusp: Any, first_layer_height: Any
) -> None:
    ways = {"z": z, "offsets": offsets, "heights": heights, "adaptive": adaptive}
    given = [name for name, value in ways.items() if value is not None]
    if len(given) > 1:
        raise UsageError(f"{given[0]} and {given[1]} contradict each other: each says where to cut")
    if given and given[0] != "heights" and layer_height is not None:
        raise UsageError(f"{given[0]} and layer_height contradict each other: each says where to cut")
    if given and first_layer_height is not None:
        raise UsageError(f"{given[0]} and first_layer_height contradict each other: each says where to cut")
    if cusp is not None and adaptive is None:
        raise UsageError("cusp goes with adaptive layers only")
