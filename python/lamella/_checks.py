"""Are layers right, and are they the same as others?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple, Union

import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import PathLike, Progress
from ._errors import UsageError
from ._files import as_stack
from ._lamella import Layer, Stack
from ._meshes import UPWARDS, MeshLike, as_mesh, placed, placing
from ._slicing import PLACES


@dataclass(frozen=True)
class Verification:
    """What `verify` finds. Lengths are millimetres."""

    ok: bool  #: no open chains, no crossings, no misoriented rings, and areas agree
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
    findings: List[str]  #: one line for each kind of finding, with the first layer and place


def verify(
    layers: Union[PathLike, Stack],
    mesh: Optional[MeshLike] = None,
    *,
    at: Optional[str] = None,
    direction: Sequence[float] = (0, 0, 1),
    transform: Optional[npt.ArrayLike] = None,
    unit_mm: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Verification:
    """Checks layers: every contour closed, outer rings counter-clockwise and holes clockwise by their nesting, none
    crossing another or itself; and, where a mesh is given, of the area of its section.

    layers: a path or a Stack.
    mesh: what was sliced, as `slice` takes it, and `direction`, `transform`, `unit_mm` as they were given there.
    at: where in their thickness the layers were cut, if not where they say: "bottom", "middle" or "top".
    threads: 0 takes one for each processor.
    progress: called as progress(stage, done, total) now and then, from the thread that called this.

    Raises InputError.
    """
    threads, progress = check.thread_count(threads), check.listener(progress)
    place = check.optional(check.choice, "at", at, PLACES)
    where = placing(direction, transform)
    if mesh is None:
        ways = {"direction": where[0] != UPWARDS, "transform": transform is not None, "unit_mm": unit_mm is not None}
        for name, given in ways.items():
            if given:
                raise UsageError(f"{name} goes with a mesh, and none is given")
    stack = as_stack("layers", layers, threads=threads, progress=progress)
    sliced = None
    if mesh is not None:
        sliced = as_mesh("mesh", mesh, unit_mm=unit_mm, threads=threads, progress=progress)
        sliced = placed(sliced, where)
    return Verification(**_lamella.verify(stack, sliced, place or "", threads, progress))


@dataclass(frozen=True)
class LayerDifference:
    """How far two layers on one plane are from each other."""

    z: float  #: of the plane, in millimetres
    distance: float  #: mm, from a corner of one to the nearest contour of the other; inf where one has none
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
    first: Union[PathLike, Stack], second: Union[PathLike, Stack], tolerance: Optional[float] = None
) -> Comparison:
    """Compares layers plane by plane.

    first, second: paths or stacks.
    tolerance: how far contours may be apart, in millimetres; what the rounding of both formats explains unless
        given, which is nothing for stacks that were sliced.

    Raises InputError.
    """
    tolerance = check.optional(check.distance, "tolerance", tolerance)
    one, other = as_stack("first", first), as_stack("second", second)
    tolerance, planes = _lamella.compare(one, other, tolerance)
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
