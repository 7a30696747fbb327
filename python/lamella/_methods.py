"""Methods of the extension's classes that have arguments. As everywhere in the package, arguments are checked in
Python, and then passed to the extension's method whose name begins with an underscore."""

from __future__ import annotations

import decimal
import functools
import inspect
import numbers
import tempfile
import webbrowser
from pathlib import Path
from typing import Annotated, Any, Callable, Dict, Iterable, List, Literal, NamedTuple, Optional, Tuple, TypeVar

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._errors import UsageError
from ._files import write
from ._looking import layer_svg, plot_layer, stack_html
from ._meshes import arrays_of_mesh
from ._shapely import contours_of, multi_polygon
from ._strategies import as_strategy
from ._warning import parts_lost, warn

T = TypeVar("T")


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


def _show_signature(cls: type) -> None:
    """Shows editors the arguments of a class of the extension, which its metaclass hides."""
    signature = inspect.signature(getattr(cls, "__init__"))
    setattr(cls, "__signature__", signature.replace(parameters=list(signature.parameters.values())[1:]))


def _methods_of(cls: type) -> Callable[[T], T]:
    """Adds the functions of the decorated class to `cls`. The decorated class has the same name, which errors of Python
    show."""

    def give(source: T) -> T:
        for name, method in vars(source).items():
            if isinstance(method, classmethod):
                setattr(cls, name, classmethod(check.arguments(method.__func__)))
            elif callable(method):
                takes_keywords = name == "__init__" or not name.startswith("_")
                setattr(cls, name, check.arguments(method) if takes_keywords else method)
                if name == "__init__":
                    _show_signature(cls)
        return source

    return give


_make_mesh: Callable[..., None] = _lamella.Mesh.__init__
_make_layer: Callable[..., None] = _lamella.Layer.__init__
_make_stack: Callable[..., None] = _lamella.Stack.__init__
_item: Callable[..., Any] = _lamella.Stack.__getitem__


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


@_methods_of(_lamella.Mesh)
class Mesh(_lamella.Mesh):
    def __init__(self, vertices: npt.ArrayLike, faces: npt.ArrayLike) -> None:
        _make_mesh(self, *arrays_of_mesh(vertices, faces))


def _one_layer(name: str, thing: Any, expected: str = "layers") -> _lamella.Layer:
    if not isinstance(thing, _lamella.Layer):
        check.refuse_type(name, expected, thing)
    return thing


def _contours(name: str, contours: Any) -> Tuple[npt.NDArray[np.float64], ...]:
    def contour(name: str, points: Any) -> npt.NDArray[np.float64]:
        expected = "contours, each an array of numbers of the shape (n, 2)"
        return check.finite(name, check.shaped(name, points, (None, 2), expected))

    return check.several(name, contours, None, "contours, each an array of the shape (n, 2)", contour)


# Types of arguments, each with its check.
Window = Annotated[npt.ArrayLike, _window]
Contours = Annotated[Iterable[npt.ArrayLike], _contours]
MitreLimit = Annotated[float, functools.partial(check.number, least=1, expected="a number, 1 or more")]


def _made_of(made: _lamella.Layer, *layers: _lamella.Layer) -> _lamella.Layer:
    lost = sum(len(layer.hatches) for layer in layers) - len(made.hatches)
    if lost > 0:
        warn([f"{lost} hatch line{'s' if lost > 1 else ''} left out: the contours that they fill were changed"])
    if merged := parts_lost(layers):
        warn([merged])
    return made


@_methods_of(_lamella.Layer)
class Layer(_lamella.Layer):
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
        _make_layer(self, rings, z, below, above, index, chains)

    @classmethod
    def from_shapely(
        cls, geometry: Any, z: float, bottom: Optional[float] = None, top: Optional[float] = None
    ) -> _lamella.Layer:
        """Returns a layer of a geometry of shapely, in millimetres: polygons become rings, outer ones counter-clockwise
        and holes clockwise; lines become open chains. A DefectWarning counts points, which are left out. `z`, `bottom`
        and `top` as for Layer."""
        rings, chains, points = contours_of("geometry", geometry)
        if points:
            warn([f"{points} point{'s' if points > 1 else ''} left out: a layer has rings and chains only"])
        return cls(rings, z, bottom, top, chains=chains)

    def __or__(self, other: Any) -> Any:
        return self.union(other) if isinstance(other, _lamella.Layer) else NotImplemented

    def __and__(self, other: Any) -> Any:
        return self.intersection(other) if isinstance(other, _lamella.Layer) else NotImplemented

    def __sub__(self, other: Any) -> Any:
        return self.difference(other) if isinstance(other, _lamella.Layer) else NotImplemented

    def __xor__(self, other: Any) -> Any:
        return self.symmetric_difference(other) if isinstance(other, _lamella.Layer) else NotImplemented

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

    def filled(self, rule: check.FillRule = "nonzero") -> _lamella.Layer:
        """Returns the layer with overlapping bodies united. Material is where the winding number satisfies `rule`:
        "nonzero", "evenodd" or "positive". Rings that do not overlap others keep their points."""
        return _made_of(self._filled(rule), self)

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
        if isinstance(distance, (numbers.Real, decimal.Decimal)) or check.is_array_of_one(distance):
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

    def union(self, other: _lamella.Layer) -> _lamella.Layer:
        """Returns the union of the material of this layer and `other`. Material is where the winding number is
        positive. Rings that intersect no others keep their points. Heights and open chains are those of this layer."""
        return _made_of(self._union(_one_layer("other", other, "a layer")), self, other)

    def intersection(self, other: _lamella.Layer) -> _lamella.Layer:
        """Returns the intersection of the material of this layer and `other`; see `union`."""
        return _made_of(self._intersection(_one_layer("other", other, "a layer")), self, other)

    def difference(self, other: _lamella.Layer) -> _lamella.Layer:
        """Returns the layer without the material of `other`; see `union`."""
        return _made_of(self._difference(_one_layer("other", other, "a layer")), self, other)

    def symmetric_difference(self, other: _lamella.Layer) -> _lamella.Layer:
        """Returns the symmetric difference of the material of this layer and `other`; see `union`."""
        return _made_of(self._symmetric_difference(_one_layer("other", other, "a layer")), self, other)

    def simplified(self, tolerance: check.Distance) -> _lamella.Layer:
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


@_methods_of(_lamella.Stack)
class Stack(_lamella.Stack):
    def __init__(self, layers: Iterable[_lamella.Layer], label: str = "part") -> None:
        several = check.several("layers", layers, None, "layers", _one_layer)
        _make_stack(self, several, check.label("label", label))
        if lost := parts_lost(several):
            warn([lost])

    def show(self) -> str:
        """Writes a page with all layers, as `write` does for a name that ends in .html, to a new folder for temporary
        files, and opens it in the browser. Returns the path of the page, which stays there."""
        path = Path(tempfile.mkdtemp(prefix="lamella-"), "layers.html")
        write(path, self)
        if not webbrowser.open(path.as_uri()):
            warn([f"no browser was found to open {path}"], RuntimeWarning)
        return str(path)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, list) or getattr(index, "ndim", 0) > 0:
            return self._chosen(_positions(index, len(self)))
        return _item(self, index)

    def at(self, z: float) -> _lamella.Layer:
        """Returns the layer whose material is at the height `z` in millimetres; where one layer ends and the next one
        begins, the upper one. Raises UsageError if there is none."""
        i = int(np.searchsorted(self.bottom, z, side="right")) - 1
        if i >= 0 and z <= self[i].top:
            return self[i]  # type: ignore[no-any-return]
        reach = f"they reach from {self.bottom[0]:g} to {self.top[-1]:g} mm" if len(self) else "the stack is empty"
        raise UsageError(f"z: there is no layer at {z:g} mm; {reach}")

    def _repr_html_(self) -> str:
        return stack_html(self)


@_methods_of(_lamella.LayerStream)
class LayerStream(_lamella.LayerStream):
    def __init__(self) -> None:
        raise TypeError("a lamella.LayerStream is made by lamella.iter_layers")

    def close(self) -> None:
        """Stops slicing. May be called more than once."""
        self._close()


@_methods_of(_lamella.ScanStrategy)
class ScanStrategy(_lamella.ScanStrategy):
    @classmethod
    def from_toml(cls, source: check.Readable) -> _lamella.ScanStrategy:
        """Returns the strategy of a TOML file (needs Python 3.11): a path, bytes, a file object, or the text itself, as
        `to_toml` returns it. A str with an equals sign or a line end is a text. Fields that are absent have their
        defaults.

        Raises InputError for a file that cannot be read, UsageError for anything that a strategy does not have."""
        if isinstance(source, str) and any(sign in source for sign in "=\n\r"):
            source = source.encode()
        if not check.is_file(source):
            check.refuse_type("source", "a path, bytes, a binary file, or the text of a TOML file", source)
        return as_strategy("source", source)

    def to_toml(self) -> str:
        """Returns the whole strategy as the text of a TOML file, with comments, which `scan` and the program read."""
        _lamella.check_strategy(self)
        return _lamella.strategy_text(self)

    def __str__(self) -> str:
        return _lamella.strategy_text(self)


def _attributes(base: type, rule: Any) -> Dict[str, Any]:
    """Returns the attributes that the class of the package has, without those of derived classes."""
    return {name: getattr(rule, name) for name, member in vars(base).items() if isinstance(member, property)}


def _with_attributes(cls: Any, base: Any, attributes: Dict[str, Any]) -> Any:
    made = cls.__new__(cls)
    base.__init__(made)
    for name, value in attributes.items():
        setattr(made, name, value)
    return made


def _is_its_attributes(cls: type) -> None:
    """Makes a class of strategies compare, copy and pickle its objects by their attributes."""

    def __eq__(self: Any, other: object) -> bool:
        if not isinstance(other, cls):
            return NotImplemented
        return _attributes(cls, self) == _attributes(cls, other)

    def __reduce_ex__(self: Any, protocol: int) -> Tuple[Any, ...]:
        return _with_attributes, (type(self), cls, _attributes(cls, self))

    for name, value in (("__eq__", __eq__), ("__hash__", None), ("__reduce_ex__", __reduce_ex__)):
        setattr(cls, name, value)


def _shows_its_attributes(cls: type) -> None:
    def __repr__(self: Any) -> str:
        shown = ", ".join(f"{name}={value!r}" for name, value in _attributes(cls, self).items())
        return f"{type(self).__name__}({shown})"

    setattr(cls, "__repr__", __repr__)


def _is_made_of_its_attributes(cls: type) -> None:
    """Makes a class of strategies take its attributes as keywords. A ParameterSet also takes another one to copy."""
    make: Callable[..., None] = getattr(cls, "__init__")
    defaults = getattr(cls, "__new__")(cls)
    make(defaults)
    copies = cls is _lamella.ParameterSet
    self_of_init = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    parameters = [self_of_init]
    if copies:
        parameters.append(inspect.Parameter("other", inspect.Parameter.POSITIONAL_OR_KEYWORD, default=None))
    for name, value in _attributes(cls, defaults).items():
        parameters.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=value))
    known = [parameter.name for parameter in parameters]

    def __init__(self: Any, *others: Any, **attributes: Any) -> None:
        if len(others) > copies:
            raise TypeError(f"{cls.__name__}() takes its attributes as keywords only")
        other = others[0] if others else attributes.pop("other", None) if copies else None
        if other is not None and not isinstance(other, cls):
            check.refuse_type("other", f"a lamella.{cls.__name__}", other)
        make(self, *(() if other is None else (other,)))
        for name, value in attributes.items():
            if name not in known[1:]:
                raise TypeError(f"{cls.__name__}() got an unexpected keyword argument {name!r}")
            setattr(self, name, value)

    __init__.__qualname__ = f"{cls.__name__}.__init__"  # the name in its errors
    setattr(__init__, "__signature__", inspect.Signature(parameters))
    setattr(cls, "__init__", check.arguments(__init__))
    _show_signature(cls)


_rules: Tuple[type, ...] = (
    _lamella.ContourRule, _lamella.HatchRule, _lamella.SkinRule, _lamella.SupportRule, _lamella.ScanStrategy,
)  # fmt: skip
for _rule in (_lamella.ParameterSet, *_rules):
    _is_made_of_its_attributes(_rule)
    _is_its_attributes(_rule)
for _rule in (*_rules, _lamella.ParameterSet, _lamella.ScanFigures):
    _shows_its_attributes(_rule)
