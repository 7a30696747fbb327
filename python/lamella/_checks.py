"""Verification and comparison of layers."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple, Union

from . import _arguments as check
from . import _lamella
from ._arguments import Coordinates, CutAt, Distance, FillRule, InsetAndHeight, Matrix, Positive, Progress, Readable, Threads
from ._errors import UsageError
from ._files import as_stack
from ._lamella import Layer, Stack
from ._meshes import UPWARDS
from ._plates import Sliceable, plate_of
from ._strategies import StrategyLike, as_strategy
from ._warning import warn


@dataclass(frozen=True)
class Verification:
    """Findings of `verify`. Lengths are in millimetres. They are true if they are `ok`."""

    ok: bool  #: no open chains, crossings, misoriented rings, layer gaps or overlaps; areas and centroids agree
    layers: int
    contours: int
    points: int
    open_chains: int  #: contours that are not closed
    crossings: int  #: pairs of segments that cross
    misoriented: int  #: rings whose orientation contradicts their nesting
    overlapping: int  #: rings of bodies within other bodies, which are not an error
    volume: float  #: mm^3, the sum of area times thickness
    max_area_error: Optional[float]  #: mm^2, the largest difference from the section of the mesh, if one was given
    areas_agree: bool  #: the areas of all layers agree with those of the sections within rounding
    hatches: int  #: hatch lines, which are not checked
    displaced: int  #: layers whose areas agree but whose centroids differ from those of the mesh's sections
    height_overlaps: int  #: layers that begin within the height of another one
    gaps: int  #: between layers, where the mesh has material; 0 without a mesh
    findings: List[str]  #: one line for each kind of finding, with the first layer and location

    def __bool__(self) -> bool:
        return self.ok


@check.arguments
def verify(
    layers: Union[Readable, Stack],
    mesh: Optional[Sliceable] = None,
    *,
    at: Optional[CutAt] = None,
    snap: Distance = 0,
    tolerance: Distance = 0,
    fill: Optional[FillRule] = None,
    bottom_offset: Optional[InsetAndHeight] = None,
    direction: Coordinates = (0, 0, 1),
    transform: Optional[Matrix] = None,
    unit_mm: Optional[Positive] = None,
    weld_tolerance: Optional[Positive] = None,
    drop_duplicates: bool = False,
    orient: bool = False,
    close_gaps: Optional[Positive] = None,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Verification:
    """Checks that every contour of the layers is closed, that outer rings run counter-clockwise and holes clockwise
    according to their nesting, and that no contour crosses another or itself. If a mesh is given, also checks that the
    areas and centroids of layers are those of its sections, and that there are no gaps between layers.

    layers: a Stack, or a path, bytes or a file object, as for `read`.
    mesh: the mesh or the plate that was sliced, as for `slice`, with the same `direction`, `transform` and `unit_mm`.
    at: position of the cuts within the layers if it differs from that in the file: "bottom", "middle" or "top".
    snap: as for `slice`.
    tolerance: additional tolerance of points, ends of lines and cuts, in millimetres, besides the rounding of the
        format: for layers that were rounded before, such as those of a CLI file converted to JSON.
    fill: the rule by which the layers were filled, as for `slice`; the sections of the mesh are filled by it, too.
    bottom_offset: by how much the first layers were shrunk, as for `slice`.
    weld_tolerance, drop_duplicates, orient, close_gaps: the repairs with which the mesh was sliced, as for `slice`. A
        mesh from `mend` is repaired already.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises InputError.
    """
    for name, step in (("fill", fill), ("bottom_offset", bottom_offset)):
        if step is not None and mesh is None:
            raise UsageError(f"{name} goes with a mesh, and none is given")
    stack = as_stack("layers", layers, threads, progress)
    return Verification(**_lamella.verify(
        stack, _mesh_as_sliced(locals()), at or "", snap, tolerance, close_gaps, fill or "none", bottom_offset,
        threads, progress
    ))  # fmt: skip


@dataclass(frozen=True)
class VectorVerification:
    """Findings of `verify_vectors`. They are true if they are `ok`."""

    ok: bool  #: no findings, except `unbounded`
    layers: int
    contour_vectors: int
    hatch_vectors: int
    open_chains: int  #: contours that are not closed; each exposure by itself, also for the next two
    crossings: int  #: pairs of segments that cross
    misoriented: int  #: rings whose orientation contradicts their nesting
    outside: int  #: vectors that leave the material, or are closer to its edges than the strategy allows
    too_short: int  #: hatch lines shorter than the shortest of the strategy
    inverted_rings: int  #: rings of the mesh's sections that bound no material and have no vectors; 0 without a mesh
    inverted_volume: float  #: mm^3, volume that these rings enclose
    height_overlaps: int  #: layers that begin within the height of another one
    gaps: int  #: between layers, where the mesh has material; 0 without a mesh
    unreached_layers: int  #: planes with more material that no vector reaches than the strategy accepts
    unreached_mm2: float  #: area of all such material; 0 without a strategy
    unbounded: int  #: vectors whose material is unknown
    findings: List[str]  #: one line for each kind of finding, with the first layer and location

    def __bool__(self) -> bool:
        return self.ok


@check.arguments
def verify_vectors(
    file: Readable,
    mesh: Optional[Sliceable] = None,
    *,
    strategy: StrategyLike = None,
    at: Optional[CutAt] = None,
    snap: Distance = 0,
    tolerance: Distance = 0,
    direction: Coordinates = (0, 0, 1),
    transform: Optional[Matrix] = None,
    unit_mm: Optional[Positive] = None,
    weld_tolerance: Optional[Positive] = None,
    drop_duplicates: bool = False,
    orient: bool = False,
    close_gaps: Optional[Positive] = None,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> VectorVerification:
    """Checks a file of scan vectors: the contours of each exposure must be closed, oriented and without crossings, and
    all vectors must be within the mesh or, without a mesh, within the outermost contours of their part. If the strategy
    by which they were made is given, also checks their distance from the edges, the least length of hatch lines, and
    that vectors reach all of the material.

    file: a path, bytes or a file object, as for `read`: scan vectors by `lamella slice --scan`, `lamella scan` or another program.
    mesh: the mesh or the plate that was sliced, as for `slice`, with the same `direction`, `transform` and `unit_mm`.
    strategy: as for `scan`; lamella.ScanStrategy() is the default strategy. With None, no strategy is checked.
    at: position of the cuts within the layers if it differs from that in the file: "bottom", "middle" or "top".
    snap: as for `slice`.
    tolerance: additional tolerance of points, ends of lines and cuts, in millimetres, besides the rounding of the
        format: for layers that were rounded before, such as those of a CLI file converted to JSON.
    weld_tolerance, drop_duplicates, orient, close_gaps: as for `verify`.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises InputError, and UsageError for a file without scan vectors.
    """
    known = None if strategy is None else as_strategy("strategy", strategy)
    sliced = _mesh_as_sliced(locals())
    source = check.source("file", file)
    path = os.fsdecode(source[0] if isinstance(source, tuple) else source)
    found, warnings = _lamella.verify_vectors(source, sliced, known, at or "", snap, tolerance, close_gaps, threads, progress)
    warn(f"{path}: {warning}" for warning in warnings)
    return VectorVerification(**found)


# The keywords that describe how a mesh was sliced, with the values that mean nothing.
OF_A_MESH = {
    "direction": UPWARDS, "transform": None, "unit_mm": None, "weld_tolerance": None, "drop_duplicates": False, "orient": False,
    "close_gaps": None,
}  # fmt: skip


def _mesh_as_sliced(given: Dict[str, Any]) -> Optional[_lamella.Plate]:
    if given["mesh"] is not None:
        where = (given["direction"], given["transform"])
        repairs = (given["weld_tolerance"], given["drop_duplicates"], given["orient"])
        return plate_of("mesh", given["mesh"], given["unit_mm"], where, repairs, False, 0, given["threads"], given["progress"])
    for name, nothing in OF_A_MESH.items():
        if not (given[name] is nothing or (name == "direction" and given[name] == nothing)):
            raise UsageError(f"{name} goes with a mesh, and none is given")
    return None


@dataclass(frozen=True)
class LayerDifference:
    """Two layers on one plane that differ."""

    z: float  #: height of the plane, in millimetres
    distance: float  #: mm, largest distance of contours from those of the other layer; inf if one has none
    where: Optional[Tuple[float, float]]  #: a point at that distance
    first: Optional[Layer]  #: None if only the second stack has contours there
    second: Optional[Layer]


@dataclass(frozen=True)
class Comparison:
    """Result of `compare`. It is true if the stacks agree."""

    agree: bool
    tolerance: float  #: in millimetres
    layers: int  #: number of compared layers
    same: int  #: number of compared layers that are equal, bit for bit
    differences: List[LayerDifference]  #: layers that do not agree, in ascending z

    def __bool__(self) -> bool:
        return self.agree


@check.arguments
def compare(
    first: Union[Readable, Stack],
    second: Union[Readable, Stack],
    tolerance: Optional[Distance] = None,
    *,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Comparison:
    """Compares the contours of layers plane by plane. To compare hatch lines, heights and parameters of files, use the
    program: `lamella compare`.

    first, second: stacks, or paths, bytes or file objects, as for `read`.
    tolerance: largest distance at which contours still agree, in millimetres; by default the sum of the rounding errors
        of both formats, which is 0 for stacks that were sliced.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises InputError. Issues a DefectWarning if no layers correspond because the two stacks are cut at different
    heights.
    """
    one, other = (as_stack(name, layers, threads, progress) for name, layers in (("first", first), ("second", second)))
    within, planes, cut_apart = _lamella.compare(one, other, tolerance, threads, progress)
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
    return Comparison(not differences, within, len(planes), same, differences)
