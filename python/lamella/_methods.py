"""Methods of the extension's classes that have arguments. As everywhere in the package, arguments are checked in
Python, and then passed to the extension's method whose name begins with an underscore."""

from __future__ import annotations

from typing import Any, Callable, Dict, Iterable, List, Optional, Tuple, TypeVar

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._errors import UsageError
from ._meshes import arrays_of_mesh
from ._shapely import multi_polygon
from ._warning import warn

T = TypeVar("T")


def _methods_of(cls: type) -> Callable[[T], T]:
    """Adds the functions of the decorated class to `cls`. The decorated class has the same name, which errors of Python
    show."""

    def give(source: T) -> T:
        for name, method in vars(source).items():
            if callable(method):
                setattr(cls, name, method)
        return source

    return give


_make_mesh: Callable[..., None] = _lamella.Mesh.__init__
_make_layer: Callable[..., None] = _lamella.Layer.__init__
_make_stack: Callable[..., None] = _lamella.Stack.__init__
_make_parameters: Callable[..., None] = _lamella.ParameterSet.__init__


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


def _made_of(made: _lamella.Layer, *layers: _lamella.Layer) -> _lamella.Layer:
    lost = sum(len(layer.hatches) for layer in layers) - len(made.hatches)
    if lost > 0:
        warn([f"{lost} hatch line{'s' if lost > 1 else ''} left out: the contours that they fill were changed"])
    return made


@_methods_of(_lamella.Layer)
class Layer(_lamella.Layer):
    def __init__(
        self,
        rings: Iterable[npt.ArrayLike],
        z: float,
        bottom: Optional[float] = None,
        top: Optional[float] = None,
        index: int = 0,
        chains: Iterable[npt.ArrayLike] = (),
    ) -> None:
        height = check.number("z", z)
        below = height if bottom is None else check.number("bottom", bottom)
        above = height if top is None else check.number("top", top)
        if not below <= height <= above:
            raise UsageError(
                f"z: {check.excerpt(z)} is not possible; a layer is cut between its bottom, {below}, and its top, {above}"
            )
        number = check.whole("index", index)
        _make_layer(self, _contours("rings", rings), height, below, above, number, _contours("chains", chains))

    def polygons(self) -> List[Tuple[int, List[int]]]:
        """Returns the polygons of the material as pairs (outer, holes): the index of the outer ring, and the list of
        the indices of its holes. Open chains, and rings that bound no material, are left out."""
        return self._polygons()

    def to_shapely(self) -> Any:
        """Returns the material as a valid shapely.geometry.MultiPolygon in millimetres, with its holes; overlapping
        bodies are united. Open chains are left out. Needs shapely."""
        return multi_polygon(self)

    def filled(self, rule: check.FillRule = "nonzero") -> _lamella.Layer:
        """Returns the layer with overlapping bodies united. Material is where the winding number satisfies `rule`:
        "nonzero", "evenodd" or "positive". Rings that do not overlap others keep their points."""
        if check.text("rule", rule) not in ("nonzero", "evenodd", "positive"):
            raise UsageError(f'rule: "{check.excerpt(rule)}" is no fill rule; there are nonzero, evenodd and positive')
        return _made_of(self._filled(rule), self)

    def offset(self, distance: float, corners: check.Corners = "mitre") -> _lamella.Layer:
        """Returns the layer with its material grown by `distance` millimetres, or shrunk if that is negative. `corners`
        is the join of moved edges that separate at a corner: "mitre", "bevel" or "round"."""
        if check.text("corners", corners) not in ("mitre", "bevel", "round"):
            raise UsageError(f'corners: "{check.excerpt(corners)}" are no corners; there are mitre, bevel and round')
        return _made_of(self._offset(check.number("distance", distance), corners), self)

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

    def simplified(self, tolerance: float) -> _lamella.Layer:
        """Returns the layer with fewer points. No contour moves by more than `tolerance` millimetres."""
        return _made_of(self._simplified(check.distance("tolerance", tolerance)), self)


@_methods_of(_lamella.Stack)
class Stack(_lamella.Stack):
    def __init__(self, layers: Iterable[_lamella.Layer], label: str = "part") -> None:
        _make_stack(self, check.several("layers", layers, None, "layers", _one_layer), check.label("label", label))


@_methods_of(_lamella.LayerStream)
class LayerStream(_lamella.LayerStream):
    def __init__(self) -> None:
        raise TypeError("a lamella.LayerStream is made by lamella.iter_layers")

    def close(self) -> None:
        """Stops slicing. May be called more than once."""
        self._close()


@_methods_of(_lamella.ParameterSet)
class ParameterSet(_lamella.ParameterSet):
    def __init__(self, other: Optional[_lamella.ParameterSet] = None) -> None:
        if other is None:
            _make_parameters(self)
            return
        if not isinstance(other, _lamella.ParameterSet):
            check.refuse_type("other", "a lamella.ParameterSet", other)
        _make_parameters(self, other)


def _attributes(base: type, rule: Any) -> Dict[str, Any]:
    """Returns the attributes that the class of the package has, without those of derived classes."""
    return {name: getattr(rule, name) for name in dir(base) if not name.startswith("_")}


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


def _is_made_of_nothing(cls: type) -> None:
    make: Callable[..., None] = getattr(cls, "__init__")

    def __init__(self: Any) -> None:
        make(self)

    __init__.__qualname__ = f"{cls.__name__}.__init__"  # the name in its errors
    setattr(cls, "__init__", __init__)


_rules: Tuple[type, ...] = (
    _lamella.ContourRule, _lamella.HatchRule, _lamella.SkinRule, _lamella.SupportRule, _lamella.ScanStrategy,
)  # fmt: skip
for _rule in _rules:
    _is_made_of_nothing(_rule)
for _rule in (*_rules, _lamella.ParameterSet):
    _is_its_attributes(_rule)
