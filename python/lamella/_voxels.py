"""Meshes as arrays of voxels."""

from __future__ import annotations

from typing import Any, List, Optional, Sequence, Union

import numpy as np

from . import _arguments as check
from . import _lamella
from ._arguments import Coordinates, Positive, Progress, Threads
from ._errors import UsageError
from ._meshes import UPWARDS, MeshLike, is_mesh
from ._pixels import AS_THE_AXES, Direction, Shape, Spacing, Voxels, cells_of
from ._plates import Part, plate_of
from ._warning import warn


@check.arguments
def voxels(
    meshes: Union[MeshLike, Part, Sequence[Union[MeshLike, Part]]],
    spacing: Spacing,
    *,
    origin: Optional[Coordinates] = None,
    shape: Optional[Shape] = None,
    direction: Direction = AS_THE_AXES,
    labels: bool = True,
    unit_mm: Optional[Positive] = None,
    max_memory: int = 0,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Voxels:
    """Returns an array (layers, rows, columns) of voxels of meshes, which has the position of the voxels, in the words of
    ITK. Each layer of voxels is cut in its middle.

    meshes: a mesh as for `slice`, a Part, or a list of them; a pair of arrays is one mesh. Each object of a 3MF or AMF file is
        a part of its own.
    spacing: the size of a voxel in millimetres, or three numbers, along columns, rows and layers (x, y, z).
    origin: x, y and z of the centre of the first voxel. By default, voxels begin where the meshes do.
    shape: (layers, rows, columns); by default voxels reach to the end of the meshes, or beyond.
    direction: a matrix (3, 3), or its nine numbers row by row, whose columns are the directions of columns, rows and layers: of
        length 1, and perpendicular to each other. By default they are those of x, y and z.
    labels: True for the numbers of parts, from 1 on, as uint8, or uint16 if there are more than 255. If material takes half of
        the section of a voxel or more, the voxel has the number of the part that takes the most of it, and of equal ones the
        first; otherwise it is 0. Voxels.labels has the names of the parts. False for 255 times the fraction of the section
        that is material, rounded, as uint8; several parts count once.
    unit_mm: millimetres per unit, for files that do not specify their unit; 1 by default. A Part has its own.
    max_memory: largest number of bytes that the array, and reading a file, may take; otherwise a LimitError is raised. 0 means
        three quarters of the memory of the machine.
    threads: number of threads; 0 means one for each processor. The result is the same for any number.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Raises UsageError, also for more than 65,535 rows or columns, InputError and LimitError. Issues a DefectWarning if
    contours do not close because a mesh has holes, or if rings bound no material because triangles face inwards.
    """
    axes: Any = direction
    matrix = np.reshape(axes, (3, 3))
    # The meshes are moved so that the voxels lie along the axes.
    to_voxels = np.eye(4)
    to_voxels[:3, :3] = np.linalg.inv(matrix)
    whole = (UPWARDS, None if axes == AS_THE_AXES else to_voxels)
    plate = plate_of("meshes", _parts(meshes, unit_mm), None, whole, (None, False, False), False, max_memory, threads, progress)
    sizes: Any = spacing
    start = None if origin is None else to_voxels[:3, :3] @ np.array(origin)
    first, count = cells_of("spacing", plate.bounds, sizes, start, shape)
    fill = _lamella.labels if labels else _lamella.coverage
    array, defects = fill(plate, count, first, sizes, max_memory, threads, progress)
    warn(f"{plate.names[file]}: {text}" for file, text in defects)
    where: Any = tuple(map(float, matrix @ np.array(first) if origin is None else origin))
    names = tuple(plate.labels) if labels else ()
    return Voxels(array, where, sizes, axes, names)


def _parts(meshes: Any, unit_mm: Optional[float]) -> List[Part]:
    several = isinstance(meshes, list) or (isinstance(meshes, tuple) and not is_mesh(meshes))
    things = list(meshes) if several else [meshes]
    if not things:
        raise UsageError("meshes: expected a mesh or several, found none")
    if unit_mm is not None and any(isinstance(one, Part) for one in things):
        raise UsageError("unit_mm: each part has its own, such as lamella.Part(..., unit_mm=25.4)")
    return [one if isinstance(one, Part) else Part(one, unit_mm=unit_mm if check.is_file(one) else None) for one in things]
