"""Slice files and mesh files, in and out."""

from __future__ import annotations

import os
from typing import Iterable, Iterator, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _lamella
from ._errors import InputError, UsageError
from ._lamella import Layer, LayerStream, Mesh, Stack
from ._meshes import PathLike, Progress, is_path, read_mesh, thread_count
from ._warning import warn

MESH_EXTENSIONS = (".stl", ".ply", ".obj")

BATCH_LAYERS = 64
BATCH_POINTS = 2**22  # 64 MB

Layers = Union[Stack, LayerStream, Sequence[Stack]]


def read_layers(
    path: PathLike, *, max_memory: int = 0, threads: int = 0, progress: Optional[Progress] = None
) -> Stack:
    stack, warnings = _lamella.read_layers(os.fsencode(path), max_memory, thread_count(threads), progress)
    warn(f"{os.fsdecode(path)}: {warning}" for warning in warnings)
    return stack


def read(
    path: PathLike,
    *,
    unit_mm: Optional[float] = None,
    strict: bool = False,
    supports: bool = False,
    max_triangles: int = 0,
    max_memory: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Union[Mesh, Stack]:
    """Reads a mesh file or a slice file, whichever it is by its content.

    path: str or os.PathLike. Meshes: STL, 3MF, AMF, OBJ, PLY, OFF. Layers: Common Layer Interface, layered SVG, SLC,
        3MF with slices, JSON, NumPy arrays. Each may be packed with gzip.
    unit_mm: millimetres per unit of a mesh file that does not say its unit; 1 unless given.
    strict: makes a DefectError of what is otherwise a DefectWarning.
    supports: takes what 3MF and AMF files mark as support, too, as solids; without it a DefectWarning says that it was
        left out.
    max_triangles: more of them are a LimitError; 0 is any number.
    max_memory: more bytes than this for what is read are a LimitError; 0 is three quarters of the memory there is.
    threads: 0 takes one for each processor.
    progress: called as progress(stage, done, total) now and then, from the thread that called this.

    Gives a Mesh or a Stack. A binary STL file is not copied but mapped: while its Mesh lives, the file may be replaced or
    deleted, but must not be written to or cut shorter.

    Raises InputError that names the file, the place in it, what was found, and what was
    expected.
    """

    def mesh() -> Mesh:
        return read_mesh(
            path, unit_mm=unit_mm, strict=strict, supports=supports, max_triangles=max_triangles, max_memory=max_memory,
            threads=threads, progress=progress,
        )  # fmt: skip

    def layers() -> Stack:
        return read_layers(path, max_memory=max_memory, threads=threads, progress=progress)

    kind = _lamella.file_kind(_head_of(path))
    if kind == "layers":
        return layers()
    if kind == "mesh":
        return mesh()
    # A 3MF file may hold either, or both: then its meshes are mostly stand-ins.
    try:
        return layers()
    except InputError:
        return mesh()


def _head_of(path: PathLike) -> bytes:
    """The first bytes; none of what cannot be opened, which its reader reports."""
    try:
        with open(path, "rb") as file:
            return file.read(4096)
    except OSError:
        return b""


def as_stack(layers: Union[PathLike, Stack], *, threads: int = 0, progress: Optional[Progress] = None) -> Stack:
    if isinstance(layers, Stack):
        return layers
    if isinstance(layers, (str, bytes, os.PathLike)):
        return read_layers(layers, threads=threads, progress=progress)
    raise TypeError(f"layers are a path or a lamella.Stack; this is a {type(layers).__name__}")


def write(
    path: PathLike,
    what: Union[Mesh, Layers],
    *,
    format: str = "",
    units_mm: Optional[float] = None,
    short_form: bool = False,
    pixel_mm: Union[None, float, Tuple[float, float]] = None,
    pixels: Optional[Tuple[int, int]] = None,
    display_mm: Optional[Tuple[float, float]] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> None:
    """Writes layers or a mesh to a file, whose extension says the format. Nobody ever sees half a file.

    path: str or os.PathLike. Meshes: .stl, .ply, .obj. Layers: see `layer_formats`.
    what: a Mesh; or a Stack, several stacks on the same planes, which are the parts of the file, or what
        `iter_layers` gives, which is written while it is being made.
    format: name of the format of layers, where the extension does not say it.
    units_mm: Common Layer Interface: millimetres per unit, to which coordinates are rounded; 0.001 unless given.
    short_form: Common Layer Interface, binary: coordinates of 16 bits.
    pixel_mm, pixels, display_mm: pictures: size of a pixel, their number, and size of the display, each along x and
        y; of these three, two tell the third.
    threads: that layers are formatted on; 0 takes one for each processor. The file is the same.
    progress: called as progress("write", done, total), in layers.

    Raises OutputError, and UsageError for a format that is not known. Issues a DefectWarning for what the format has
    no place for.
    """
    if isinstance(what, Mesh):
        _write_mesh(path, what)
        return
    thread_count(threads)
    parts, planes, bottom, rule = _planes(what)
    pixel = (pixel_mm, pixel_mm) if isinstance(pixel_mm, (int, float)) else pixel_mm
    writer = _lamella.open_writer(
        os.fsencode(path), format, parts, _length(what), bottom, rule, units_mm, short_form, pixel, pixels,
        display_mm,
    )
    done, total = 0, _length(what)
    for batch in _batches(planes):
        writer.write(batch, threads)
        done += len(batch)
        if progress is not None:
            progress("write", done, total)
    warn(f"{os.fsdecode(path)}: {warning}" for warning in writer.finish())


def _batches(planes: Iterable[List[Layer]]) -> Iterator[List[List[Layer]]]:
    """Planes that are formatted together: enough for all threads, as far as memory is meant for layers in flight."""
    batch: List[List[Layer]] = []
    points = 0
    for plane in planes:
        batch.append(plane)
        points += sum(len(layer.points) for layer in plane)
        if len(batch) == BATCH_LAYERS or points >= BATCH_POINTS:
            yield batch
            batch, points = [], 0
    if batch:
        yield batch


def _write_mesh(path: PathLike, mesh: Mesh) -> None:
    extension = os.path.splitext(os.fsdecode(path))[1].lower()
    if extension not in MESH_EXTENSIONS:
        raise UsageError(
            f"{os.fsdecode(path)}: meshes are written as {', '.join(MESH_EXTENSIONS)}; slice the mesh to get layers"
        )
    _lamella.write_mesh(os.fsencode(path), extension, mesh, mesh.name or "lamella")


def _length(what: Layers) -> int:
    if isinstance(what, LayerStream):
        return len(what.z)
    return len(what) if isinstance(what, Stack) else len(what[0])


def _planes(what: Layers) -> Tuple[List[Tuple[str, npt.NDArray[np.float64]]], Iterator[List[Layer]], float, str]:
    """The label and the bounds of each part, the layers plane by plane, where the first one begins, and the rule of the
    plane."""
    if isinstance(what, LayerStream):
        return [(what.label, what.bounds)], ([layer] for layer in what), what._bottom, what.rule
    parts = what.parts if isinstance(what, Stack) else list(what)
    if not parts or not all(isinstance(part, Stack) for part in parts):
        raise TypeError("what is written is a lamella.Mesh, a lamella.Stack, a list of these, or a stream of layers")
    if len(parts[0]) == 0:
        raise UsageError("there are no layers to write")
    if any(len(part) != len(parts[0]) or (part.z != parts[0].z).any() for part in parts):
        raise UsageError("the parts of a file must have the same planes: slice them at the same z")
    if any(part.rule != parts[0].rule for part in parts):
        raise UsageError("the parts of a file must be cut by the same rule: slice them with the same `at`")
    names = [(part.label or "part", part.bounds) for part in parts]
    planes = (list(plane) for plane in zip(*parts))
    return names, planes, parts[0][0].bottom, parts[0].rule


def convert(
    source: PathLike,
    target: PathLike,
    *,
    format: str = "",
    units_mm: Optional[float] = None,
    short_form: bool = False,
    pixel_mm: Union[None, float, Tuple[float, float]] = None,
    pixels: Optional[Tuple[int, int]] = None,
    display_mm: Optional[Tuple[float, float]] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> None:
    """Reads the layers of a slice file and writes them in another format. Contours stay as they are, up to the
    rounding of the new format; parts and labels are kept.

    source, target: str or os.PathLike.
    For the rest see `write`.

    Raises InputError, OutputError, and UsageError.
    """
    if is_path(source) and is_path(target) and os.path.exists(target) and os.path.samefile(source, target):
        raise UsageError(f"{os.fsdecode(target)}: the output would overwrite the input")
    stack = read_layers(source, threads=threads, progress=progress)
    if len(stack) == 0:
        raise InputError(f"{os.fsdecode(source)}: holds no layers")
    write(
        target, stack, format=format, units_mm=units_mm, short_form=short_form, pixel_mm=pixel_mm, pixels=pixels,
        display_mm=display_mm, threads=threads, progress=progress,
    )  # fmt: skip


def layer_formats() -> List[Tuple[str, str, str]]:
    """The formats that layers are written in: (name, extension, one line about it) of each."""
    return _lamella.layer_formats()
