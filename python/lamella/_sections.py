"""Sections of meshes with single planes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Union, overload

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import Coordinates, Positive, Progress, Rule, Threads
from ._errors import UsageError
from ._lamella import Layer, Mesh
from ._meshes import MeshLike, as_mesh


@dataclass(frozen=True, eq=False)
class Section:
    """The section of a mesh with a plane of any direction."""

    layer: Layer  #: the contours within the plane, in millimetres from its origin; z is 0
    matrix: npt.NDArray[np.float64]  #: (4, 4): maps (x, y, 0, 1) of the layer to the coordinates of the mesh

    @property
    def polylines(self) -> List[npt.NDArray[np.float64]]:
        """Returns the contours in the coordinates of the mesh: (n, 3) arrays, rings first; the first point of a ring is
        not repeated at its end."""
        points = self.layer.points @ self.matrix[:3, :2].T + self.matrix[:3, 3]
        return np.split(points, self.layer.offsets[1:-1]) if len(points) else []


class Slicer:
    """A mesh that is prepared for many single planes. A plane then costs in proportion to the triangles that it cuts,
    not to all of them. Threads may share a slicer.

    part: a path, bytes, a file object, or another mesh, as for `slice`.
    rule: what a plane through vertices cuts: "section_above" is the section just above the plane, "section_below" the
        one just below it.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default.
    threads: number of threads that prepare; 0 means one for each processor. No result depends on it.
    progress: called as progress(stage, done, total) from time to time, on the calling thread. The stages are "read" and
        "link". An exception that it raises stops the work and reaches the caller.

    Raises UsageError, InputError, LimitError.
    """

    @check.arguments
    def __init__(
        self,
        part: MeshLike,
        *,
        rule: Rule = "section_above",
        unit_mm: Optional[Positive] = None,
        threads: Threads = 0,
        progress: Optional[Progress] = None,
    ) -> None:
        self.mesh: Mesh = as_mesh("part", part, unit_mm, False, 0, threads, progress)
        self._prepared = _lamella.PreparedMesh(self.mesh, rule, threads, progress)

    @overload
    def section(self, z: float) -> Layer: ...
    @overload
    def section(self, *, origin: Coordinates, normal: Coordinates) -> Section: ...
    @check.arguments
    def section(
        self,
        z: Optional[float] = None,
        *,
        origin: Optional[Coordinates] = None,
        normal: Optional[Coordinates] = None,
    ) -> Union[Layer, Section]:
        """Returns the section with one plane.

        z: the height of a horizontal plane in millimetres. The result is a Layer with the contours that `slice` gives
            for this height, bit for bit; without contours if the plane misses the mesh.

        origin, normal: a point (x, y, z) of a plane of any direction, and its normal (x, y, z) of any length. The result
            is a Section. The side of each vertex v is decided exactly, by the sign of (v - origin) · normal for these
            numbers; the rule says what a plane through a face cuts, where above is the side that the normal points to.

        Raises UsageError.
        """
        if z is not None:
            if origin is not None or normal is not None:
                raise UsageError("z contradicts origin and normal: each says where to cut")
            return self._prepared.level(z)
        if origin is None or normal is None:
            raise UsageError("section: expected z, or origin and normal")
        if not any(normal):
            raise UsageError("normal: (0, 0, 0) has no direction; expected three numbers (x, y, z), not all 0")
        return Section(*self._prepared.tilted(tuple(origin), tuple(normal)))

    def __repr__(self) -> str:
        return f"<lamella.Slicer: {len(self.mesh)} triangles>"
