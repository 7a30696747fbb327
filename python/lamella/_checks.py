"""Are layers right, and are they the same as others?"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple, Union

import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import CutAt, PathLike, Progress
from ._errors import UsageError
from ._files import as_stack
from ._lamella import Layer, Mesh, Stack
from ._meshes import UPWARDS, MeshLike, Placing, as_mesh, placed, placing
from ._scanning import StrategyLike, as_strategy
from ._slicing import PLACES
from ._warning import warn


@dataclass(frozen=True)
class Verification:
    """What `verify` finds. Lengths are millimetres."""

    ok: bool  #: no open chains, crossings, misoriented rings, layer gaps or overlaps; areas and centres agree
    layers: int
    contours: int
    points: int
    open_chains: int  #: contours that are not closed
    crossings: int  #: pairs of segments that cross
    misoriented: int  #: rings that run the wrong way round for where they lie
    overlapping: int  #: rings of bodies within other bodies; no error
    volume: float  #: mm^3, the sum of area times thickness
    max_area_error: Optional[float]  #: mm^2, the largest difference from the section of the mesh, if one was given
    areas_agree: bool  #: those differences are no larger than rounding explains
    displaced: int  #: layers of the right area that lie elsewhere than the mesh's section, as their centres tell
    height_overlaps: int  #: layers that begin within the height of another one
    gaps: int  #: between layers, where the mesh has material; 0 without one
    findings: List[str]  #: one line for each kind of finding, with the first layer and place


def verify(
    layers: Union[PathLike, Stack],
    mesh: Optional[MeshLike] = None,
    *,
    at: Optional[CutAt] = None,
    snap: float = 0,
    tolerance: float = 0,
    direction: Sequence[float] = (0, 0, 1),
    transform: Optional[npt.ArrayLike] = None,
    unit_mm: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Verification:
    """Checks layers: every contour closed, outer rings counter-clockwise and holes clockwise by their nesting, none
    crossing another or itself; and, where a mesh is given, of the area of its section, where that is, without gaps between
    layers.

    layers: a path or a Stack.
    mesh: what was sliced, as `slice` takes it, and `direction`, `transform`, `unit_mm` as they were given there.
    at: where in their thickness the layers were cut, if not where they say: "bottom", "middle" or "top".
    snap: as it was given to `slice`.
    tolerance: how far points, ends of lines and cuts may be off, in millimetres, beside what the format rounds: for
        layers that were rounded before, such as those of a CLI file that became JSON.
    threads: 0 takes one for each processor.
    progress: called as progress(stage, done, total) now and then, from the thread that called this.

    Raises InputError.
    """
    threads, progress = check.thread_count(threads), check.listener(progress)
    place = check.optional(check.choice, "at", at, PLACES)
    snap, tolerance = check.distance("snap", snap), check.distance("tolerance", tolerance)
    stack = as_stack("layers", layers, threads=threads, progress=progress)
    sliced = _mesh_as_sliced(mesh, placing(direction, transform), transform is not None, unit_mm, threads, progress)
    return Verification(**_lamella.verify(stack, sliced, place or "", snap, tolerance, threads, progress))


@dataclass(frozen=True)
class VectorVerification:
    """What `verify_vectors` finds."""

    ok: bool  #: nothing of what follows, but for `unbounded`
    layers: int
    contour_vectors: int
    hatch_vectors: int
    open_chains: int  #: contours that are not closed; of each exposure by themselves, as the next two
    crossings: int  #: pairs of segments that cross
    misoriented: int  #: rings that run the wrong way round for where they lie
    outside: int  #: vectors that leave the material, or are nearer to its edges than the strategy says
    too_short: int  #: hatch lines shorter than the shortest of the strategy
    misplaced: int  #: hatch lines beside those of the strategy, turned otherwise or of another exposure
    miscovered: int  #: planes of a part whose lines cover more or less than they are to fill
    wrong_contours: int  #: that are missing on a plane, or of another area than the material has at their depth
    inverted_rings: int  #: of the mesh's sections, that bound no material and have no vectors; 0 without a mesh
    inverted_volume: float  #: mm^3, what these enclose
    height_overlaps: int  #: layers that begin within the height of another one
    gaps: int  #: between layers, where the mesh has material; 0 without one
    cover: Optional[float]  #: what lines cover by what they are to fill, where a strategy is given
    unreached_layers: int  #: planes with more material that no vector reaches than the strategy accepts
    unreached_mm2: float  #: all such material; 0 without a strategy
    unbounded: int  #: vectors of which nothing tells where the material is
    findings: List[str]  #: one line for each kind of finding, with the first layer and place


def verify_vectors(
    path: PathLike,
    mesh: Optional[MeshLike] = None,
    *,
    strategy: StrategyLike = None,
    at: Optional[CutAt] = None,
    snap: float = 0,
    tolerance: float = 0,
    direction: Sequence[float] = (0, 0, 1),
    transform: Optional[npt.ArrayLike] = None,
    unit_mm: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> VectorVerification:
    """Checks a file of scan vectors: contours of each exposure closed, oriented and without crossings, and all vectors
    within the mesh, or without one within the outermost contours of their part; with the strategy by which they were
    made, as far from its edges as that says, each contour there, all lines at their distance and angle, none shorter than the
    shortest, and enough of them to fill it.

    path: of a file that `lamella slice --scan` or `lamella scan` wrote, or other programs, with scan vectors.
    mesh: what was sliced, as `slice` takes it, and `direction`, `transform`, `unit_mm` as they were given there.
    strategy: as `scan` takes it; lamella.ScanStrategy() is the one by default, None does not ask for any.
    at: where in their thickness the layers were cut, if not where they say: "bottom", "middle" or "top".
    snap: as it was given to `slice`.
    tolerance: how far points, ends of lines and cuts may be off, in millimetres, beside what the format rounds: for
        layers that were rounded before, such as those of a CLI file that became JSON.
    threads: 0 takes one for each processor.
    progress: called as progress(stage, done, total) now and then, from the thread that called this.

    Raises InputError, and UsageError for a file without scan vectors.
    """
    file = check.path("path", path)
    threads, progress = check.thread_count(threads), check.listener(progress)
    place = check.optional(check.choice, "at", at, PLACES)
    snap, tolerance = check.distance("snap", snap), check.distance("tolerance", tolerance)
    known = None if strategy is None else as_strategy("strategy", strategy)
    sliced = _mesh_as_sliced(mesh, placing(direction, transform), transform is not None, unit_mm, threads, progress)
    found, warnings = _lamella.verify_vectors(file, sliced, known, place or "", snap, tolerance, threads, progress)
    warn(f"{os.fsdecode(file)}: {warning}" for warning in warnings)
    return VectorVerification(**found)


def _mesh_as_sliced(
    mesh: Optional[MeshLike],
    where: Placing,
    transformed: bool,
    unit_mm: Optional[float],
    threads: int,
    progress: Optional[Progress],
) -> Optional[Mesh]:
    if mesh is not None:
        return placed(as_mesh("mesh", mesh, unit_mm=unit_mm, threads=threads, progress=progress), where, threads)
    ways = {"direction": where[0] != UPWARDS, "transform": transformed, "unit_mm": unit_mm is not None}
    for name, given in ways.items():
        if given:
            raise UsageError(f"{name} goes with a mesh, and none is given")
    return None


@dataclass(frozen=True)
class LayerDifference:
    """How far two layers on one plane are from each other."""

    z: float  #: of the plane, in millimetres
    distance: float  #: mm, from a point of one's contours to the nearest contour of the other; inf where one has none
    where: Optional[Tuple[float, float]]  #: where that distance begins
    first: Optional[Layer]  #: None where only the second stack has contours there
    second: Optional[Layer]


@dataclass(frozen=True)
class Comparison:
    """What `compare` finds. It is true where the stacks agree."""

    agree: bool
    tolerance: float  #: in millimetres
    layers: int  #: that were compared
    same: int  #: of these, those that are the same to the last bit
    differences: List[LayerDifference]  #: layers that do not agree, in ascending z

    def __bool__(self) -> bool:
        return self.agree


def compare(
    first: Union[PathLike, Stack],
    second: Union[PathLike, Stack],
    tolerance: Optional[float] = None,
    *,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Comparison:
    """Compares the contours of layers plane by plane. Hatch lines, heights and parameters of files are compared by the
    program: `lamella compare`.

    first, second: paths or stacks.
    tolerance: how far contours may be apart, in millimetres; what the rounding of both formats explains unless
        given, which is nothing for stacks that were sliced.
    threads: 0 takes one for each processor.
    progress: called as progress(stage, done, total) now and then, from the thread that called this.

    A DefectWarning says so where no layers belong together since the lowest of both are cut at different heights.
    Raises InputError.
    """
    tolerance = check.optional(check.distance, "tolerance", tolerance)
    threads, progress = check.thread_count(threads), check.listener(progress)
    one = as_stack("first", first, threads=threads, progress=progress)
    other = as_stack("second", second, threads=threads, progress=progress)
    tolerance, planes, cut_apart = _lamella.compare(one, other, tolerance, threads, progress)
    if cut_apart:
        low, high = one[0], other[0]
        warn(
            [
                "the stacks are cut at different heights: the layer from "
                f"z = {low.bottom:g} to {low.top:g} mm at {low.z:g} mm in the first and at {high.z:g} mm in the second; "
                "formats that do not keep the cut, such as CLI, are read as if it were in the middle"
            ]
        )
    same = 0
    differences = []
    for i, j, equal, agree, distance, where in planes:
        same += equal
        a, b = None if i is None else one[i], None if j is None else other[j]
        if a is None or b is None:
            differences.append(LayerDifference((a or b).z, math.inf, None, a, b))  # type: ignore[union-attr]
        elif not agree:
            differences.append(LayerDifference(a.z, distance, where if math.isfinite(distance) else None, a, b))
    return Comparison(not differences, tolerance, len(planes), same, differences)
