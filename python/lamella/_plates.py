"""Plates: meshes at their positions, which are sliced together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, List, Literal, Optional, Sequence, Tuple, Union

import numpy as np

from . import _arguments as check
from . import _lamella
from ._arguments import Coordinates, Distance, Matrix, Positive, Progress, Vector
from ._errors import DefectError, UsageError
from ._lamella import Mesh
from ._meshes import UPWARDS, Mending, MeshLike, Placing, as_mesh, placed


def _scale(name: str, value: Any) -> Tuple[float, ...]:
    if check.is_number(value):
        value = (value,) * 3
    return check.several(name, value, 3, "a number, or three (x, y, z)", check.positive)


@check.construction
@dataclass(frozen=True, eq=False)
class Part:
    """A mesh on a plate, with its position and its role. In this order it is transformed by the matrix, scaled, rotated
    and moved.

    mesh: a mesh as for `slice`. Each object of a 3MF or AMF file is a part of its own.
    matrix: a (4, 4) matrix in millimetres.
    scale: a factor, or one for each axis.
    rotation: degrees about the x axis, then y, then z.
    position: by how much it is moved along x, y and z, in millimetres.
    copies: this many copies, side by side in rows; `spacing` is the gap between them in millimetres.
    label: its name in slice files; by default that of the object in its file, or of the file.
    role: "solid"; "support", for which scan vectors are made by a rule of their own; or "negative", which is no part, and is
        subtracted from all others.
    unit_mm: millimetres per unit, for a file that does not specify its unit; 1 by default.
    """

    mesh: MeshLike
    matrix: Optional[Matrix] = None
    scale: Annotated[Union[float, Vector], _scale] = 1
    rotation: Coordinates = (0, 0, 0)
    position: Coordinates = (0, 0, 0)
    copies: Annotated[int, partial(check.whole, least=1)] = 1
    spacing: Distance = 5
    label: str = ""
    role: Literal["solid", "support", "negative"] = "solid"
    unit_mm: Optional[Positive] = None

    def _on_plate(self, mesh: Mesh) -> Tuple[Any, ...]:
        """Returns the part as the extension takes it, with the mesh that was read."""
        pose = (self.scale, self.rotation, self.position)
        matrix = np.eye(4) if self.matrix is None else self.matrix
        label = check.label("label", self.label) or (b"" if mesh.path else b"part")
        return mesh, pose, matrix, self.copies, self.spacing, label, self.role == "support", self.role == "negative"


Sliceable = Union[MeshLike, Part, Sequence[Part]]


def _parts(name: str, part: Any) -> List[Part]:
    """Returns the parts of a plate; none for a mesh."""
    if isinstance(part, Part):
        return [part]
    if not (isinstance(part, (list, tuple)) and any(isinstance(one, Part) for one in part)):
        return []
    for one in part:
        if not isinstance(one, Part):
            check.refuse_type(name, "a lamella.Part, as the others of the plate are", one)
    return list(part)


def plate_of(
    name: str,
    part: Sliceable,
    unit_mm: Optional[float],
    whole: Placing,
    mending: Mending,
    strict: bool,
    max_memory: int,
    threads: int,
    progress: Optional[Progress],
) -> _lamella.Plate:
    """Returns the plate of a mesh or of parts. `whole` places all of it."""

    def mesh_of(thing: MeshLike, unit_mm: Optional[float]) -> Mesh:
        mesh = as_mesh(name, thing, unit_mm, strict, max_memory, threads, progress)
        if strict:
            defects = mesh._defects(threads, progress)
            if defects:
                raise DefectError(f"{mesh.path or 'the mesh'}: the mesh has defects: {defects}")
        return mesh

    parts = _parts(name, part)
    if not parts:
        mesh = placed(mesh_of(part, unit_mm), whole, threads)  # type: ignore[arg-type]
        return _lamella.plate_of_mesh(mesh, mending, threads, progress)
    if unit_mm is not None:
        raise UsageError("unit_mm: each part of a plate has its own, such as lamella.Part(..., unit_mm=25.4)")
    on_plate: List[Any] = [one._on_plate(mesh_of(one.mesh, one.unit_mm)) for one in parts]
    direction, transform = whole
    return _lamella.plate_of_parts(
        on_plate, transform, None if direction == UPWARDS else direction, mending, max_memory, threads, progress
    )
