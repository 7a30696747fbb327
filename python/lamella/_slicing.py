"""Slicing of meshes."""

from __future__ import annotations

import functools
import inspect
from typing import TYPE_CHECKING, Annotated, Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import Coordinates, CutAt, Distance, FillRule, InsetAndHeight, Matrix, Positive, Progress, Threads
from ._errors import DefectError, UsageError
from ._lamella import LayerStream, Stack
from ._plates import Sliceable, plate_of
from ._warning import warn, with_arguments

if TYPE_CHECKING:
    from typing_extensions import ParamSpec

    P = ParamSpec("P")
R = TypeVar("R")

DEFAULT_LAYER_HEIGHT = 0.1
DEFAULT_CUSP = 0.05
LAST = 2**64 - 1  # an end above all layers


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


RANGES = "ranges, each of three numbers (from, to, layer_height)"


def _ranges(name: str, values: Any) -> Tuple[Tuple[float, ...], ...]:
    def one(name: str, value: Any) -> Tuple[float, ...]:
        return check.several(name, value, 3, RANGES, check.number)

    return check.several(name, values, None, RANGES, one)


def _pair_of(words: str, each: Callable[[str, Any], float]) -> Callable[[str, Any], Tuple[float, float]]:
    return lambda name, value: check.pair(name, value, f"two numbers {words}", each)


# Types of arguments, each with its check.
Heights = Annotated[npt.ArrayLike, _heights]
HeightRanges = Annotated[Union[Sequence[Tuple[float, float, float]], npt.NDArray[Any]], _ranges]
SmallestAndLargest = Annotated[Tuple[float, float], _pair_of("(smallest, largest)", check.positive)]
HeightRange = Annotated[Tuple[float, float], _pair_of("(from, to)", check.number)]
IndexRange = Annotated[Tuple[int, Optional[int]], _index_range]
EngineName = Annotated[str, lambda name, value: check.choice(name, value, [known.name for known in engines()])]


def _with_the_parameters_of(source: Callable[P, object]) -> Callable[[Callable[[Dict[str, Any]], R]], Callable[P, R]]:
    """Gives a function the parameters of `source`; it gets them as a dict."""
    parameters = inspect.signature(getattr(source, "__wrapped__"))

    def give(function: Callable[[Dict[str, Any]], R]) -> Callable[P, R]:
        @functools.wraps(function)
        def call(*arguments: Any, **keywords: Any) -> R:
            try:
                bound = parameters.bind(*arguments, **keywords)
            except TypeError as error:
                raise TypeError(f"{function.__name__}() {error}") from None
            bound.apply_defaults()
            return function(dict(bound.arguments))

        returned = inspect.signature(function).return_annotation
        setattr(call, "__signature__", parameters.replace(return_annotation=returned))
        setattr(call, "__annotations__", {**source.__annotations__, "return": returned})
        return check.arguments(call)

    return give


@check.arguments
def slice(
    part: Sliceable,
    layer_height: Optional[Positive] = None,
    *,
    z: Optional[Heights] = None,
    offsets: Optional[Heights] = None,
    heights: Optional[HeightRanges] = None,
    adaptive: Optional[SmallestAndLargest] = None,
    cusp: Optional[Positive] = None,
    first_layer_height: Optional[Positive] = None,
    at: CutAt = "middle",
    z_range: Optional[HeightRange] = None,
    layers: Optional[IndexRange] = None,
    snap: Distance = 0,
    direction: Coordinates = (0, 0, 1),
    transform: Optional[Matrix] = None,
    unit_mm: Optional[Positive] = None,
    weld_tolerance: Optional[Positive] = None,
    drop_duplicates: bool = False,
    orient: bool = False,
    close_gaps: Optional[Positive] = None,
    fill: Optional[FillRule] = None,
    bottom_offset: Optional[InsetAndHeight] = None,
    engine: EngineName = "sweep",
    strict: bool = False,
    max_memory: int = 0,
    threads: Threads = 0,
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
        horizontal except for rounding, and must be less than half of the thinnest layer.
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

    bottom_offset: (inset, height) in millimetres, against the bulge of the first layers in resin (elephant's foot):
        contours move inwards by `inset` at the bottom of the part, or of the lowest part of a plate, and by less and less
        up to `height` above it. Holes grow. Contours that overlap have to be united by `fill` first.
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
    plate, plan, engine, threads, progress = _prepared(locals())
    stack = _lamella.slice_stack(plate, plan, engine, threads, progress)
    doubts = _named(plate, _lamella.mesh_doubts(stack, plate))
    if strict and doubts:
        raise DefectError(with_arguments(doubts[0]))
    warn(doubts)
    return stack


@_with_the_parameters_of(slice)
def iter_layers(given: Dict[str, Any]) -> LayerStream:
    """Yields the layers of a mesh one by one, in ascending z, while the next ones are computed. This is for parts whose
    layers do not fit into memory: the number of layers that wait for the caller is bounded.

    Takes what `slice` takes and gives the same layers. The mesh is read before this function returns; later errors are
    raised by the iterator. To stop early, leave the loop, call close(), or use `with`.

    strict: inspects the mesh first. Otherwise there is no warning about open chains (see Layer.open_chains) and rings
        that bound no material.
    """
    return _lamella.stream(*_prepared(given))


def _named(plate: _lamella.Plate, texts: List[Tuple[int, str]]) -> List[str]:
    return [f"{plate.names[file]}: {text}" for file, text in texts]


Prepared = Tuple[_lamella.Plate, _lamella.Plan, str, int, Optional[Progress]]


def _prepared(given: Dict[str, Any]) -> Prepared:
    """Returns the plate, the plan by which it is cut, the engine, and the arguments of the execution."""
    _check_conflicts(given)
    execution: Tuple[int, Optional[Progress]] = (given["threads"], given["progress"])
    strict, max_memory = given["strict"], given["max_memory"]
    where = (given["direction"], given["transform"])
    repairs = (given["weld_tolerance"], given["drop_duplicates"], given["orient"])
    plate = plate_of("part", given["part"], given["unit_mm"], where, repairs, strict, max_memory, *execution)
    selection = (given["at"], given["z_range"], given["layers"], given["snap"])
    plan = _lamella.plan(
        plate, _cut_of(given, plate), *selection, given["close_gaps"], given["fill"] or "none",
        given["bottom_offset"], max_memory, *execution
    )  # fmt: skip
    doubts = _named(plate, _lamella.near_faces(plate, plan, *execution))
    if strict and doubts:
        raise DefectError(with_arguments(doubts[0]))
    warn(doubts)
    return (plate, plan, given["engine"], *execution)


Cut = Union[_lamella.UniformLayers, _lamella.ListedPlanes, _lamella.HeightRanges, _lamella.AdaptiveLayers]


def _cut_of(given: Dict[str, Any], plate: _lamella.Plate) -> Cut:
    height = DEFAULT_LAYER_HEIGHT if given["layer_height"] is None else given["layer_height"]
    if given["offsets"] is not None:
        return _lamella.ListedPlanes(given["offsets"] + plate.bottom)
    if given["z"] is not None:
        return _lamella.ListedPlanes(given["z"])
    if given["adaptive"] is not None:
        lowest, highest = given["adaptive"]
        return _lamella.AdaptiveLayers(lowest, highest, DEFAULT_CUSP if given["cusp"] is None else given["cusp"])
    if given["heights"] is not None:
        if not given["heights"]:
            raise UsageError(f"heights: expected {RANGES}, found none")
        return _lamella.HeightRanges(given["heights"], height)
    return _lamella.UniformLayers(height, given["first_layer_height"])


def _check_conflicts(values: Dict[str, Any]) -> None:
    ways = {name: values[name] for name in ("z", "offsets", "heights", "adaptive")}
    given = [name for name, value in ways.items() if value is not None]
    if len(given) > 1:
        raise UsageError(f"{given[0]} and {given[1]} contradict each other: each says where to cut")
    if given and given[0] != "heights" and values["layer_height"] is not None:
        raise UsageError(f"{given[0]} and layer_height contradict each other: each says where to cut")
    if given and values["first_layer_height"] is not None:
        raise UsageError(f"{given[0]} and first_layer_height contradict each other: each says where to cut")
    if values["cusp"] is not None and values["adaptive"] is None:
        raise UsageError("cusp goes with adaptive layers only")
