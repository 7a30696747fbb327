"""Reading and writing of slice files and mesh files."""

from __future__ import annotations

import os
from functools import partial
from typing import Annotated, Any, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._arguments import (
    Antialias, BinaryWriter, FillRule, InsetAndHeight, Lengths, Mirror, Orientation, PathLike, Positive, Progress, Readable,
    Threads, Words, Writable,
)  # fmt: skip
from ._errors import CancelledError, DefectError, InputError, UsageError
from ._lamella import Exposure, Layer, LayerStream, Mesh, ResinSettings, Stack
from ._meshes import MeshLike, as_mesh, is_mesh
from ._rules import tables_of
from ._scanning import ScanLayer, ScanStream
from ._warning import parts_lost, warn, with_arguments

MESH_FORMATS = ("stl", "ply", "obj")

# The options of formats, each with the property that a format must have for it to apply.
OPTIONS = {
    "units_mm": "units", "short_form": "short_form", "pixel_mm": "picture", "pixels": "picture", "display_mm": "picture",
    "printer": "picture", "orientation": "picture", "mirror": "picture", "antialias": "picture", "gamma": "picture",
    "grey_curve": "picture", "part_colours": "part_colours",
    "resin": "exposure", "exposure_s": "exposure", "first_exposure_s": "exposure", "fade_layers": "exposure",
}  # fmt: skip
# Formats that store the heights of layers unchanged, or no heights. They accept layers without thickness.
WITHOUT_THICKNESS = ("json", "npz", "raw", "dxf", "geojson", "svg-layers", "png", "png-zip")

BATCH_LAYERS = 64
BATCH_POINTS = 2**22  # 64 MB

Layers = Union[Layer, Stack, LayerStream, ScanLayer, Iterable[Layer], Iterable[Stack], Iterable[ScanLayer]]

# Label and bounds of a part, the exposure of its vectors (if it has any), and whether it is a support.
Part = Tuple[bytes, npt.NDArray[np.float64], Optional[Exposure], bool]
# The parts, the layers plane by plane, the number of planes, the bottom of the first layer, and the plane rule.
Planes = Tuple[List[Part], Iterator[List[Layer]], int, float, str]

# Values that layers of all parts on a plane have in common.
HEIGHTS = {"z": "cuts (z)", "bottom": "bottoms", "top": "tops", "index": "indices"}


def _columns_and_rows(name: str, value: Any) -> Tuple[int, int]:
    return check.pair(name, value, "two whole numbers (columns, rows)", partial(check.whole, least=1, most=check.MOST_PIXELS))


def _grey_curve(name: str, points: Any) -> Tuple[Tuple[float, float], ...]:
    words = "pairs of two numbers (covered part, grey value)"

    def one(name: str, value: Any) -> Tuple[float, float]:
        return check.pair(name, value, words, check.number)

    return check.several(name, points, None, words, one)


def _part_colours(name: str, colours: Any) -> Tuple[Tuple[int, ...], ...]:
    words = "True, or three whole numbers from 0 to 255 (red, green, blue) for each part"

    def one(name: str, value: Any) -> Tuple[int, ...]:
        return check.several(name, value, 3, words, partial(check.whole, most=255))

    return () if colours is True else check.several(name, colours, None, words, one)


def _resin_settings(name: str, settings: Any) -> ResinSettings:
    if isinstance(settings, ResinSettings):  # which this function made
        return settings
    if isinstance(settings, Mapping):
        return ResinSettings(name.encode(), settings)
    if not check.is_file(settings):
        check.refuse_type(name, "a TOML file, or a dict of its settings", settings)
    path, text = check.content(name, settings)
    return ResinSettings(os.fsencode(path), tables_of(path, text))


# Types of arguments, each with its check.
Resin = Annotated[Union[Mapping[str, Any], Readable], _resin_settings]
GreyCurve = Annotated[Sequence[Tuple[float, float]], _grey_curve]
PartColours = Annotated[Union[bool, Sequence[Tuple[int, int, int]]], _part_colours]
Pixels = Annotated[Tuple[int, int], _columns_and_rows]
Count = Annotated[int, partial(check.whole, most=2**32 - 1)]


@check.arguments
def read_layers(
    file: Readable,
    *,
    strict: bool = False,
    max_memory: int = 0,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Stack:
    """Reads a slice file; the content determines the format.

    file: a path, bytes, or a file object that is open for reading bytes; see `read`. Formats: Common Layer Interface,
        layered SVG, SLC, 3MF with slices, JSON, NumPy arrays, ILT, Open Vector Format, 3MF with toolpaths. Each may be
        compressed with gzip.
    strict: raises a DefectError instead of issuing a DefectWarning.
    max_memory, threads, progress: as for `read`.

    Raises InputError for a file without layers, and LimitError.
    """
    return stack_of_file("file", file, strict, max_memory, threads, progress)


def stack_of_file(
    name: str, file: Any, strict: bool, max_memory: int, threads: int, progress: Optional[Progress]
) -> Stack:
    stack, warnings = _lamella.read_layers(check.source(name, file), max_memory, threads, progress)
    _told(stack.path, warnings, strict)
    return stack


def _told(path: str, warnings: Sequence[str], strict: bool) -> None:
    """Issues the warnings of a slice file; with `strict` raises the first one as an error."""
    texts = [f"{path}: {warning}" for warning in warnings]
    if strict and texts:
        raise DefectError(texts[0])
    warn(texts)


@check.arguments
def read(
    file: Readable,
    *,
    unit_mm: Optional[Positive] = None,
    strict: bool = False,
    include: Words = (),
    max_triangles: int = 0,
    max_memory: int = 0,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> Union[Mesh, Stack]:
    """Reads a mesh file or a slice file; the content determines the format. If only one of them will do, `read_mesh` and
    `read_layers` refuse the other.

    file: a path (str or os.PathLike), bytes, or a file object that is open for reading bytes, such as an io.BytesIO,
        which is read from its position to its end. Errors name an object by its `name` or its type. For the formats
        see `read_mesh` and `read_layers`.
    unit_mm: millimetres per unit, for a mesh file that does not specify its unit; 1 by default. Not
        permitted for slice files.
    strict: raises a DefectError instead of issuing a DefectWarning.
    include, max_triangles: as for `read_mesh`.
    max_memory: largest number of bytes in memory; otherwise a LimitError is raised. 0 means three quarters of the
        physical memory. An uncompressed binary STL file does not count, nor does data that is computed from a mesh
        afterwards.
    threads: number of threads; 0 means one for each processor.
    progress: called as progress(stage, done, total) from time to time, on the calling thread.

    Returns a Mesh or a Stack. The file is copied before it is parsed and may change afterwards; an InputError is raised
    if it becomes shorter while it is copied. A copy larger than a quarter of `max_memory` is kept in an anonymous
    temporary file, in $TMPDIR, /var/tmp or /tmp.

    Raises InputError that reports the file, the location in it, the content found and the content expected, and
    UsageError if `unit_mm` is given for a slice file.
    """
    source = check.source("file", file)
    read, warnings = _lamella.read_any(
        source, unit_mm, strict, include, max_triangles, max_memory, threads, progress  # type: ignore[arg-type]
    )
    if isinstance(read, Stack) and unit_mm is not None:
        raise UsageError(f"unit_mm goes with meshes, and {read.path} holds layers, which say their unit")
    # Reading a mesh has already checked `strict`.
    _told(read.path, warnings, strict and isinstance(read, Stack))
    return read


def as_stack(name: str, layers: Union[Readable, Stack], threads: int, progress: Optional[Progress]) -> Stack:
    if isinstance(layers, Stack):
        return layers
    if check.is_file(layers):
        return stack_of_file(name, layers, False, 0, threads, progress)
    check.refuse_type(name, "a path, bytes, a binary file or a lamella.Stack", layers)


@check.arguments
def write(
    file: Writable,
    content: Union[MeshLike, Layers],
    *,
    format: str = "",
    units_mm: Optional[Positive] = None,
    short_form: bool = False,
    pixel_mm: Optional[Lengths] = None,
    pixels: Optional[Pixels] = None,
    display_mm: Optional[Lengths] = None,
    printer: Optional[str] = None,
    orientation: Optional[Orientation] = None,
    mirror: Optional[Mirror] = None,
    antialias: Optional[Antialias] = None,
    gamma: Optional[Positive] = None,
    grey_curve: Optional[GreyCurve] = None,
    part_colours: Optional[PartColours] = None,
    resin: Optional[Resin] = None,
    exposure_s: Optional[Positive] = None,
    first_exposure_s: Optional[Positive] = None,
    fade_layers: Optional[Count] = None,
    strict: bool = False,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> None:
    """Writes layers or a mesh to a file, whose extension selects the format. No reader ever sees an incomplete file.

    file: a path (str or os.PathLike), or a file object that is open for writing bytes, such as an io.BytesIO. A file
        object gets all bytes at once, after the last layer, and not compressed. Meshes: .stl, .ply, .obj. Layers: see `layer_formats`.
    content: a Mesh, a pair of arrays (vertices, faces), or another object that `slice` takes as a mesh; a Layer, a
        Stack, or any iterable of layers in ascending z; several stacks on the same planes, which become the parts of
        the file; or scan vectors from `scan`. A stream from `iter_layers`, and the result of `scan` for such a stream
        or for a Stack, is written while it is computed; layers of any other iterable are collected first.
    format: name of the format, if the extension does not select it: one of `layer_formats`, or "stl", "ply" or "obj".
    units_mm: millimetres per unit in Common Layer Interface, ILT and 3MF with toolpaths; 0.001 by default. Coordinates
        are rounded to whole units with short_form, in "cli-ascii" and in "3mf-toolpath".
    short_form: writes coordinates of 16 bits, in binary Common Layer Interface and ILT.

    Images (png, png-zip, and the formats of resin printers):
    pixel_mm, pixels, display_mm: size of a pixel, number of pixels, and size of the display, each along x and y; any
        two of these three determine the third. Values not given are those of the printer; without a printer, pixels are
        0.05 mm wide.
    printer: name of a resin printer, or a part of it that no other printer has: determines the display. `lamella printers`
        lists them.
    orientation: "landscape" if x runs from left to right in an image, "portrait" if x runs upwards.
    mirror: "none", "x", "y" or "xy".
    antialias: 1 for black and white, by the centres of pixels; 2 to 64 for grey values, which are the covered fractions
        of pixels, exact for up to that many corners close together; 8 by default.
    gamma: exponent of grey values: 255 times the covered fraction to this power; 1 by default.
    grey_curve: pairs (covered fraction from 0 to 1, grey value from 0 to 255), instead of gamma. Values between two pairs
        are interpolated; [(0, 60)] makes 60 the darkest grey.
    part_colours: (red, green, blue) from 0 to 255 for each part, or True for colours that are chosen (png, png-zip): each
        pixel has the colour of the part in which its centre lies, and is transparent outside of all parts.
    resin: settings of the resin (formats of resin printers): a TOML file, as `lamella resin show` prints one (needs Python
        3.11), or a dict of the same keys, such as {"exposure_s": 2.5, "exposure_ranges": {"0:0.4": 35}}. Values not
        given are those of the printer.
    exposure_s, first_exposure_s: exposure time in seconds of a layer, and of each of the first layers (formats of resin
        printers), instead of those of `resin`.
    fade_layers: number of layers over which the first exposure fades to the normal one; sl1, sl1s: 10 by default.

    strict: raises a DefectError instead of issuing a DefectWarning, and writes no file.
    threads: number of threads that format layers; 0 means one for each processor. The file does not depend on it.
    progress: called as progress("write", done, total), in layers.

    Raises OutputError, UsageError for an unknown format and for options that do not apply to it, and TypeError. Issues
    a DefectWarning for content that the format cannot represent.
    """
    options = {name: value for name, value in locals().items() if name in OPTIONS and value is not None and value is not False}
    target, output = check.target("file", file)
    known = os.fsdecode(target)
    if is_mesh(content):
        _write_mesh(target, output, as_mesh("content", content), format, list(options), strict)
        return
    parts, planes, total, bottom, rule = _planes(content, strict)
    name = _format_for(target, format, options)
    if name not in WITHOUT_THICKNESS and not (isinstance(content, Stack) and content.path):
        planes = _with_thickness(name, planes)
    writer = _lamella.open_writer(
        target, name, parts, total, bottom, rule, {**options, "strict": strict}, output is not None
    )
    done = 0
    try:
        for batch in _batches(planes):
            writer.write(batch, threads)
            done += len(batch)
            if progress is not None:
                progress("write", done, total)
        if done < total:
            raise CancelledError(f"{known}: the stream was closed while it was written")
        warnings = writer.finish()
        if output is not None:
            check.put(output, writer.content())
    finally:
        writer.close()  # at once, even if an exception keeps the writer alive
    warn(f"{known}: {warning}" for warning in warnings)


def _with_thickness(name: str, planes: Iterable[List[Layer]]) -> Iterator[List[Layer]]:
    for plane in planes:
        if not plane[0].bottom < plane[0].top:
            raise UsageError(
                f"content: the layer at z = {plane[0].z:g} mm has no thickness, and {name} needs one; give lamella.Layer its "
                "bottom= and top="
            )
        yield plane


def _format_for(path: bytes, format: str, given: Iterable[str]) -> str:
    """Returns the name of the format, to which all given options apply."""
    if format:
        check.choice("format", format, [row[0] for row in layer_formats()])
    name = _lamella.layer_format(format, path)
    for option in given:
        formats = _lamella.formats_with(OPTIONS[option])
        if name not in formats:
            several = "formats" if len(formats) > 1 else "format"
            raise UsageError(f"{option} goes with the {several} {', '.join(formats)}, not with {name}")
    return name


def _batches(planes: Iterable[List[Layer]]) -> Iterator[List[List[Layer]]]:
    """Yields lists of planes that are formatted together, with enough planes for all threads, but limited memory."""
    batch: List[List[Layer]] = []
    points = 0
    for plane in planes:
        batch.append(plane)
        points += sum(len(layer.points) + 2 * len(layer.hatches) for layer in plane)
        if len(batch) == BATCH_LAYERS or points >= BATCH_POINTS:
            yield batch
            batch, points = [], 0
    if batch:
        yield batch


def _write_mesh(
    target: bytes, output: Optional[BinaryWriter], mesh: Mesh, format: str, given: List[str], strict: bool
) -> None:
    known = os.fsdecode(target)
    name = format or os.path.splitext(known)[1].lower()[1:]
    if name not in MESH_FORMATS:
        raise UsageError(
            f"{known}: meshes are written as {', '.join(MESH_FORMATS)}, by the extension or `format`; slice the mesh to "
            "get layers"
        )
    if given:
        raise UsageError(f"{given[0]} goes with layers, and the content is a mesh")
    label = check.label("name", mesh.name or "lamella")
    warnings, written = _lamella.write_mesh(target, name, mesh, label, strict, output is not None)
    if output is not None:
        check.put(output, written)
    warn(f"{known}: {warning}" for warning in warnings)


def _planes(content: Any, strict: bool) -> Planes:
    if isinstance(content, LayerStream):
        total = len(content)
        if total == 0:
            raise UsageError("content: there are no layers to write: the stream is closed or at its end")
        heads: List[Part] = [(label, box, None, support) for label, box, support in content._parts]
        return heads, (layer.parts for layer in content), total, content._bottom, content.rule
    if isinstance(content, ScanStream):
        total = len(content)
        return _planes_of_vectors(content, content.first(), total, content.boxes, content.rule)
    things = _collected(content)
    if isinstance(things[0], ScanLayer):
        return _planes_of_scan_layers(things)
    if strict and isinstance(things[0], Layer) and (lost := parts_lost(things)):
        raise DefectError(f"content: {lost}")
    stacks = things if isinstance(things[0], Stack) else [Stack(things)]
    return _planes_of_parts([part for stack in stacks for part in stack.parts])


def _planes_of_parts(stacks: List[Stack]) -> Planes:
    if len(stacks[0]) == 0:
        raise UsageError("content: there are no layers to write")
    for name, words in HEIGHTS.items():
        first = [getattr(layer, name) for layer in stacks[0]] if len(stacks) > 1 else []
        if any([getattr(layer, name) for layer in stack] != first for stack in stacks[1:]):
            raise UsageError(
                f"content: the parts of a file must have the same planes, and their {words} differ: "
                "slice them at the same z"
            )
    if any(stack.rule != stacks[0].rule for stack in stacks):
        raise UsageError("content: the parts of a file must be cut by the same rule: slice them with the same `at`")
    parts: List[Part] = [
        (check.label("label", stack.label or "part"), box, stack.exposure, stack.support)
        for stack, box in zip(stacks, _boxes(stacks))
    ]
    planes = (list(plane) for plane in zip(*stacks))
    return parts, planes, len(stacks[0]), stacks[0][0].bottom, stacks[0].rule


def _boxes(stacks: List[Stack]) -> List[npt.NDArray[np.float64]]:
    """Returns the boxes of parts. A part without contours does not enlarge the box of the file if other parts have
    contours."""
    boxes = [stack._box for stack in stacks]
    return boxes if any(np.isfinite(box).all() for box in boxes) else [stack.bounds for stack in stacks]


def _planes_of_scan_layers(layers: List[ScanLayer]) -> Planes:
    exposures = layers[0].exposures
    if any(layer.exposures != exposures for layer in layers):
        raise UsageError("content: the scan layers of a file must have the same exposures: scan them by one strategy")
    stacks = [Stack([layer.layers[k] for layer in layers]) for k in range(len(exposures))]
    return _planes_of_vectors(layers, layers[0], len(layers), _boxes(stacks), stacks[0].rule)


def _planes_of_vectors(
    layers: Iterable[ScanLayer],
    first: Optional[ScanLayer],
    total: int,
    boxes: Iterable[npt.NDArray[np.float64]],
    rule: str,
) -> Planes:
    if first is None:
        raise UsageError("content: there are no layers to write")
    parts: List[Part] = [
        (check.label("label", f"{exposure.part} {exposure.name}"), box, exposure, exposure.region == "support")
        for exposure, box in zip(first.exposures, boxes)
    ]
    planes = (list(layer.layers) for layer in layers)
    return parts, planes, total, first.bottom, rule


def _collected(content: Any) -> List[Any]:
    """Returns a list of at least one object, all of one kind: layers, stacks or scan layers."""
    expected = "a mesh, a lamella.Layer or Stack, or an iterable of layers, stacks or scan layers"
    if isinstance(content, (Layer, Stack, ScanLayer)):
        return [content]
    if isinstance(content, (str, bytes)):
        check.refuse_type("content", expected, content)
    try:
        things = iter(content)
    except TypeError:
        check.refuse_type("content", expected, content)
    found = list(things)
    if not found:
        raise UsageError("content: there are no layers to write")
    kind = next((kind for kind in (Stack, ScanLayer) if isinstance(found[0], kind)), Layer)
    for thing in found:
        if not isinstance(thing, kind):
            check.refuse_type("content", expected, thing)
    return found


@check.arguments
def convert(
    source: Readable,
    target: Writable,
    *,
    fill: Optional[FillRule] = None,
    bottom_offset: Optional[InsetAndHeight] = None,
    format: str = "",
    units_mm: Optional[Positive] = None,
    short_form: bool = False,
    pixel_mm: Optional[Lengths] = None,
    pixels: Optional[Pixels] = None,
    display_mm: Optional[Lengths] = None,
    printer: Optional[str] = None,
    orientation: Optional[Orientation] = None,
    mirror: Optional[Mirror] = None,
    antialias: Optional[Antialias] = None,
    gamma: Optional[Positive] = None,
    grey_curve: Optional[GreyCurve] = None,
    part_colours: Optional[PartColours] = None,
    resin: Optional[Resin] = None,
    exposure_s: Optional[Positive] = None,
    first_exposure_s: Optional[Positive] = None,
    fade_layers: Optional[Count] = None,
    strict: bool = False,
    threads: Threads = 0,
    progress: Optional[Progress] = None,
) -> None:
    """Reads the layers of a slice file and writes them in another format. Contours are unchanged except for the
    rounding of the new format; parts and labels are kept.

    source: a path, bytes or a file object, as for `read`.
    target: a path or a file object, as for `write`.
    fill: unites contours of a part that overlap. Material is where the winding number satisfies this rule: "nonzero",
        "evenodd" or "positive".
    bottom_offset: (inset, height) in millimetres, as for `slice`; heights count from the bottom of the first layer.
    For the rest see `write`.

    Raises InputError, OutputError, UsageError and TypeError. Issues a DefectWarning if the file has defects or rings
    that bound no material; with `strict` it raises DefectError.
    """
    path, output = check.target("target", target)
    if output is None and isinstance(source, (str, os.PathLike)) and _same_file(source, path):
        raise UsageError(f"{os.fsdecode(path)}: the output would overwrite the input")
    given = locals()
    stack = stack_of_file("source", source, strict, 0, threads, progress)
    if len(stack) == 0:
        raise InputError(f"{stack.path}: holds no layers")
    if fill is None and all(part.exposure is None for part in stack.parts):
        inverted = [f"{stack.path}: {text}" for text in _lamella.inverted_layers(stack, threads, progress)]
        if strict and inverted:
            raise DefectError(with_arguments(inverted[0]))
        warn(inverted)
    if fill is not None or bottom_offset is not None:
        stack = _after_steps(stack, fill, bottom_offset, strict, threads, progress)
    options = {name: given[name] for name in OPTIONS}
    write(target, stack, format=format, strict=strict, threads=threads, progress=progress, **options)


def _after_steps(
    stack: Stack,
    fill: Optional[str],
    bottom_offset: Optional[Tuple[float, float]],
    strict: bool,
    threads: int,
    progress: Optional[Progress],
) -> Stack:
    step, earlier = ("fill", "fill") if fill else ("bottom_offset", "shrink layers")
    for part in stack.parts:
        if part.exposure is not None:
            raise UsageError(f"{stack.path}: holds scan vectors ({part.label}), and {step} is for contours: {earlier} before scan")
    changed, warnings = _lamella.after_steps(stack, fill or "none", bottom_offset, threads, progress)
    _told(stack.path, warnings, strict)
    return changed


def _same_file(first: PathLike, second: bytes) -> bool:
    try:
        return os.path.samefile(first, second)
    except (OSError, ValueError):  # at least one does not exist; opening it will report that
        return False


def mesh_formats() -> List[str]:
    """Returns the extensions of the formats from which meshes can be read, such as "stl"."""
    return _lamella.mesh_extensions()


def layer_formats() -> List[Tuple[str, str, str]]:
    """Returns the formats to which layers can be written, each as (name, extension, description in one line)."""
    return _lamella.layer_formats()
