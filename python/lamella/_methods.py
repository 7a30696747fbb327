"""Methods of the extension's classes that take keywords. The extension takes them from here while it makes its classes, so
this module and all that it imports do without the extension."""

from __future__ import annotations

import functools
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Iterable, List, Literal, NamedTuple, Optional, Sequence, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from ._errors import InputError, UsageError
from ._looking import layer_svg, plot_layer, stack_html
from ._pixels import Centre, PixelType, RowsAndColumns, Voxels, cells_of, distance_of
from ._printing import PrintCavity, PrintCheck, PrintIsland
from ._shapely import contours_of, multi_polygon
from ._warning import parts_lost, warn

if TYPE_CHECKING:
    from ._lamella import Layer as _Layer
    from ._lamella import LayerStream as _LayerStream
    from ._lamella import Mesh as _Mesh
    from ._lamella import Stack as _Stack
else:
    _Layer = _LayerStream = _Mesh = _Stack = object


class ContourDefect(NamedTuple):
    """A defect of a contour of a layer, as `Layer.diagnose` lists it."""

    #: "open": a chain that does not close. "crossing": it crosses a contour, which may be itself. "misoriented": a
    #: clockwise ring outside of material, which bounds none. "tangled": another ring that bounds no material, because it
    #: crosses itself or others, or lies within a misoriented one. "overlapping": a ring within material, of bodies that
    #: overlap, which is no error, or a hole with the wrong orientation.
    kind: Literal["open", "crossing", "misoriented", "tangled", "overlapping"]
    contour: int  #: index of the contour in its layer
    other: int  #: index of the contour that it crosses; for other kinds, that of the contour itself
    at: Tuple[float, float]  #: the crossing, or the first point of the contour, in millimetres


def _window(name: str, bounds: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Returns the smallest and the largest x and y: (2, 2)."""
    expected = "the smallest and the largest x and y, an array of the shape (2, 2) or (2, 3)"
    found = check.array(name, bounds, expected)
    if found.shape not in ((2, 2), (2, 3)):
        raise UsageError(f"{name}: expected {expected}, found {check.described(found)}")
    window = check.finite(name, found[:, :2].astype(np.float64))
    if (window[0] > window[1]).any():
        raise UsageError(f"{name}: expected {expected}; the smallest comes first")
    return window


def _arrays_of_mesh(vertices: Any, faces: Any) -> Tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    positions = check.shaped("vertices", vertices, (None, 3), "an array of numbers of the shape (n, 3)")
    expected = "an array of whole numbers of the shape (m, 3)"
    numbers = check.array("faces", faces, expected, kinds="iu")
    if numbers.ndim != 2 or numbers.shape[1] != 3:
        cut = "; faces of more than three corners must be cut into triangles first" if numbers.ndim == 2 else ""
        raise UsageError(f"faces: expected {expected}, found {check.described(numbers)}{cut}")
    if numbers.dtype == np.uint64 and (numbers > np.iinfo(np.int64).max).any():
        row, corner = np.argwhere(numbers > np.iinfo(np.int64).max)[0]
        raise InputError(
            f"faces: row {row} names vertex {numbers[row, corner]}, and there are {len(positions)}, counted from 0"
        )
    return positions, np.ascontiguousarray(numbers, dtype=np.int64)


class Mesh(_Mesh):
    def __init__(self, vertices: npt.ArrayLike, faces: npt.ArrayLike) -> None:
        self._make(*_arrays_of_mesh(vertices, faces))


def _contours(name: str, contours: Any) -> Tuple[npt.NDArray[np.float64], ...]:
    def contour(name: str, points: Any) -> npt.NDArray[np.float64]:
        expected = "contours, each an array of numbers of the shape (n, 2)"
        return check.finite(name, check.shaped(name, points, (None, 2), expected))

    return check.several(name, contours, None, "contours, each an array of the shape (n, 2)", contour)


# Types of arguments, each with its check.
Window = Annotated[npt.ArrayLike, _window]
Contours = Annotated[Iterable[npt.ArrayLike], _contours]
MitreLimit = Annotated[float, functools.partial(check.number, least=1, expected="a number, 1 or more")]


def _made_of(made: _Layer, *layers: _Layer) -> _Layer:
    lost = sum(len(layer.hatches) for layer in layers) - len(made.hatches)
    if lost > 0:
        warn([f"{lost} hatch line{'s' if lost > 1 else ''} left out: the contours that they fill were changed"])
    if merged := parts_lost(layers):
        warn([merged])
    return made


class Layer(_Layer):
    def __init__(
        self,
        rings: Contours,
        z: float,
        bottom: Optional[float] = None,
        top: Optional[float] = None,
        index: int = 0,
        chains: Contours = (),
    ) -> None:
        below = z if bottom is None else bottom
        above = z if top is None else top
        if not below <= z <= above:
            raise UsageError(
                f"z: {z:g} is not possible; a layer is cut between its bottom, {below}, and its top, {above}"
            )
        self._make(rings, z, below, above, index, chains)

    @classmethod
    def from_shapely(
        cls, geometry: Any, z: float, bottom: Optional[float] = None, top: Optional[float] = None
    ) -> _Layer:
        """Returns a layer of a geometry of shapely, in millimetres: polygons become rings, outer ones counter-clockwise
        and holes clockwise; lines become open chains. A DefectWarning counts points, which are left out. `z`, `bottom`
        and `top` as for Layer."""
        rings, chains, points = contours_of("geometry", geometry)
        if points:
            warn([f"{points} point{'s' if points > 1 else ''} left out: a layer has rings and chains only"])
        return cls(rings, z, bottom, top, chains=chains)

    def polygons(self) -> List[Tuple[int, List[int]]]:
        """Returns the polygons of the material as pairs (outer, holes): the index of the outer ring, and the list of
        the indices of its holes. Open chains, and rings that bound no material, are left out."""
        return self._polygons()

    def diagnose(self, *, resolution: check.Distance = 0, crossings: int = 100) -> List[ContourDefect]:
        """Returns the defects of the contours, as `verify` counts them: open chains, crossings, then rings.

        resolution: the rounding of the file that the layer comes from, in millimetres, which is Stack.resolution. Rings so
            thin that rounding can invert them may have either orientation.
        crossings: lists at most this many crossings; a DefectWarning reports if there are more.
        """
        found, total, or_more = self._diagnosed(resolution, crossings)
        if total > crossings or or_more:
            ended = " or more, so that rings were not checked" if or_more else ""
            warn([f"the layer at z = {self.z:g} mm has {total} crossings{ended}; {min(total, crossings)} of them are listed"])
        return [ContourDefect(*one) for one in found]

    def to_shapely(self) -> Any:
        """Returns the material as a valid shapely.geometry.MultiPolygon in millimetres, with its holes; overlapping
        bodies are united. Open chains are left out. Needs shapely."""
        return multi_polygon(self)

    def filled(self, rule: check.FillRule = "nonzero") -> _Layer:
        """Returns the layer with overlapping bodies united. Material is where the winding number satisfies `rule`:
        "nonzero", "evenodd" or "positive". Rings that do not overlap others keep their points."""
        return _made_of(self._filled(rule), self)

    @overload
    def offset(
        self, distance: float, corners: check.Corners = "mitre", *, mitre_limit: float = 2, arc_tolerance: float = 0.001
    ) -> _Layer: ...
    @overload
    def offset(
        self,
        distance: Union[Sequence[float], npt.NDArray[Any]],
        corners: check.Corners = "mitre",
        *,
        mitre_limit: float = 2,
        arc_tolerance: float = 0.001,
    ) -> List[_Layer]: ...
    def offset(
        self,
        distance: Any,
        corners: check.Corners = "mitre",
        *,
        mitre_limit: MitreLimit = 2,
        arc_tolerance: check.Positive = 0.001,
    ) -> Any:
        """Returns the layer with its material grown by `distance` millimetres, or shrunk if that is negative. For several
        distances returns a list with a layer for each, which takes less time than one after the other.

        corners: the join of moved edges that separate at a corner: "mitre", "bevel" or "round".
        mitre_limit: a mitre whose tip would be farther than this many distances from its corner is cut off, 1 or more.
        arc_tolerance: largest distance of the chords of round corners from their arc, in millimetres.
        """
        way = (corners, mitre_limit, arc_tolerance)
        if check.is_number(distance):
            return _made_of(self._offsets([check.number("distance", distance)], *way)[0], self)
        several = check.several("distance", distance, None, "a number or several", check.number)
        return [_made_of(made, self) for made in self._offsets(several, *way)]

    def image(
        self,
        pixel_mm: check.Lengths,
        *,
        bounds: Optional[Window] = None,
        antialias: check.Antialias = 8,
    ) -> npt.NDArray[np.uint8]:
        """Returns the material as an image: (rows, columns) uint8, the row with the largest y first. The value of a pixel
        is 255 times the fraction of it that is material, rounded.

        pixel_mm: the size of a pixel in millimetres, or two numbers, along x and y.
        bounds: the smallest and the largest x and y of the image, (2, 2) or, as those of a stack, (2, 3); by default
            those of the layer. The first pixel is at the smallest x and the largest y; the last ones may reach beyond.
        antialias: 1 for black and white, by the centres of pixels; 2 to 64 for grey values, as for `write`.

        Raises UsageError, also for more than 65,535 rows or columns.
        """
        box: Any = self.bounds if bounds is None else bounds
        if not len(self.points) and bounds is None:
            return np.zeros((0, 0), dtype=np.uint8)
        with np.errstate(over="ignore"):
            count = np.maximum(1, np.ceil((box[1] - box[0]) / pixel_mm * (1 - 1e-12)))  # quotients are rounded
        if not (count <= check.MOST_PIXELS).all():
            raise UsageError(
                f"pixel_mm: {count[0]:g} x {count[1]:g} pixels are too many; an image has at most {check.MOST_PIXELS} each way"
            )
        width, height = pixel_mm  # type: ignore[misc]
        return self._image(width, height, box[0, 0], box[1, 1], int(count[0]), int(count[1]), antialias)

    def union(self, other: _Layer) -> _Layer:
        """Returns the union of the material of this layer and `other`. Material is where the winding number is
        positive. Rings that intersect no others keep their points. Heights and open chains are those of this layer."""
        return _made_of(self._union(other), self, other)

    def intersection(self, other: _Layer) -> _Layer:
        """Returns the intersection of the material of this layer and `other`; see `union`."""
        return _made_of(self._intersection(other), self, other)

    def difference(self, other: _Layer) -> _Layer:
        """Returns the layer without the material of `other`; see `union`."""
        return _made_of(self._difference(other), self, other)

    def symmetric_difference(self, other: _Layer) -> _Layer:
        """Returns the symmetric difference of the material of this layer and `other`; see `union`."""
        return _made_of(self._symmetric_difference(other), self, other)

    def simplified(self, tolerance: check.Distance) -> _Layer:
        """Returns the layer with fewer points. No contour moves by more than `tolerance` millimetres."""
        return _made_of(self._simplified(tolerance), self)

    def plot(self, axes: Any = None) -> Any:
        """Draws the layer into axes of matplotlib, new ones if none are given, and returns the axes. Open chains are
        red. Needs matplotlib."""
        return plot_layer(self, axes)

    def _repr_svg_(self) -> str:
        return layer_svg(self)


def _positions(index: Any, count: int) -> npt.NDArray[np.int64]:
    """Returns the positions that a list of numbers or of truth values denotes, among `count` layers."""
    expected = "whole numbers that ascend, or True or False for each layer"
    found = check.array("index", index, expected, kinds="biu") if len(index) else np.zeros(0, dtype=np.int64)
    if found.ndim != 1:
        raise UsageError(f"index: expected {expected}, found {check.described(found)}")
    if found.dtype.kind == "b":
        if len(found) != count:
            raise IndexError(f"index: expected {count} truth values, one for each layer, found {len(found)}")
        return np.flatnonzero(found)
    outside = (found < -count) | (found >= count)
    if outside.any():
        raise IndexError(f"layer {found[outside][0]} of {count}")
    positions = np.where(found < 0, found + count, found).astype(np.int64)
    if (np.diff(positions) <= 0).any():
        raise UsageError(f"index: expected {expected}; layers of a stack ascend")
    return positions


class Stack(_Stack):
    def __init__(self, layers: Iterable[_Layer], label: str = "part") -> None:
        several: Tuple[Any, ...] = check.several("layers", layers, None, "layers", lambda name, layer: layer)
        self._make(several, check.label("label", label))
        if lost := parts_lost(several):
            warn([lost])

    def show(self) -> str:
        """Writes a page with all layers, as `write` does for a name that ends in .html, to a new folder for temporary
        files, and opens it in the browser. Returns the path of the page, which stays there."""
        path = Path(tempfile.mkdtemp(prefix="lamella-"), "layers.html")
        warn(f"{path}: {warning}" for warning in self._write_page(os.fsencode(path)))
        if not webbrowser.open(path.as_uri()):
            warn([f"no browser was found to open {path}"], RuntimeWarning)
        return str(path)

    @overload
    def __getitem__(self, index: Union[int, "np.integer[Any]"]) -> _Layer: ...
    @overload
    def __getitem__(self, index: Union[slice, Sequence[int], Sequence[bool], npt.NDArray[Any]]) -> _Stack: ...
    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, list) or getattr(index, "ndim", 0) > 0:
            return self._chosen(_positions(index, len(self)))
        return self._item(index)

    def pixels(
        self,
        pixel_size: check.Lengths,
        *,
        dtype: PixelType = "uint8",
        origin: Optional[Centre] = None,
        shape: Optional[RowsAndColumns] = None,
        max_memory: int = 0,
        threads: check.Threads = 0,
        progress: Optional[check.Progress] = None,
    ) -> Voxels:
        """Returns the material of all layers as an array (layers, rows, columns). Unlike those of `Layer.image`, rows
        ascend in y, as images of ITK have them: `array[k, j, i]` is at x and y of `origin` + (i, j) `pixel_size`.

        pixel_size: the size of a pixel in millimetres, or two numbers, along x and y.
        dtype: numpy.uint8 for 255 times the fraction of the pixel that is material, rounded; bool for whether its centre
            is. Several parts count once. Open chains are ignored.
        origin: x and y of the centre of the first pixel; by default its corner is at the smallest x and y of `bounds`.
        shape: (rows, columns); by default they reach to the largest x and y of `bounds`, or beyond.
        max_memory: largest number of bytes that the array may take; otherwise a LimitError is raised. 0 means three
            quarters of the memory of the machine.
        threads: number of threads; 0 means one for each processor. The result is the same for any number.
        progress: called as progress(stage, done, total) from time to time, on the calling thread.

        Raises UsageError, also for more than 65,535 rows or columns, and LimitError.
        """
        width, height = pixel_size  # type: ignore[misc]
        (x, y), count = cells_of("pixel_size", self.bounds[:, :2], (width, height), origin, shape)
        inside = np.dtype(dtype) == np.bool_
        middles = (self.bottom + self.top) / 2
        grid = (len(middles), *count), (x, y, 0.0), (width, height, 1.0)
        array = self._pixels(*grid, inside, max_memory, threads, progress)
        z = float(middles[0]) if len(middles) else 0.0
        return Voxels(array, (x, y, z), (width, height, distance_of(middles, self.top - self.bottom)))

    def at(self, z: float) -> _Layer:
        """Returns the layer whose material is at the height `z` in millimetres; where one layer ends and the next one
        begins, the upper one. Raises UsageError if there is none."""
        i = int(np.searchsorted(self.bottom, z, side="right")) - 1
        if i >= 0 and z <= self[i].top:
            return self[i]
        reach = f"they reach from {self.bottom[0]:g} to {self.top[-1]:g} mm" if len(self) else "the stack is empty"
        raise UsageError(f"z: there is no layer at {z:g} mm; {reach}")

    def check(
        self,
        *,
        touch: check.Distance = 0,
        overhang_angle: check.Positive = 45,
        threads: check.Threads = 0,
        progress: Optional[check.Progress] = None,
    ) -> PrintCheck:
        """Finds what makes prints in resin fail: islands, overhangs, cups, traps, and empty layers. Parts that are
        supports carry others.

        touch: material that shares no more than this area with the layer below is an island, too, in square millimetres.
        overhang_angle: the smallest angle between a surface and the plate at which each layer is carried by the one below,
            in degrees.
        threads: number of threads; 0 means one for each processor.
        progress: called as progress(stage, done, total) from time to time, on the calling thread.
        """
        fields = self._checked(touch, overhang_angle, threads, progress)
        fields["islands"] = [PrintIsland(*one) for one in fields["islands"]]
        fields["cavities"] = [PrintCavity(*one) for one in fields["cavities"]]
        return PrintCheck(**fields)

    def _repr_html_(self) -> str:
        return stack_html(self)


class LayerStream(_LayerStream):
    def __init__(self) -> None:
        raise TypeError("a lamella.LayerStream is made by lamella.iter_layers")

    def close(self) -> None:
        """Stops slicing. May be called more than once."""
        self._close()


def complete(cls: type) -> None:
    """Gives a class of the extension the methods of the class of this name. Errors of Python show this name."""
    check.give_methods(cls, globals()[cls.__name__])
