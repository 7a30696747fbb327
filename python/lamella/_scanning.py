"""Scan vectors of layers, for powder-bed machines."""

from __future__ import annotations

import os
from collections import deque
from dataclasses import dataclass
from itertools import chain, islice
from typing import Any, Deque, Generator, Iterable, Iterator, List, Literal, Optional, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from . import _lamella
from ._errors import InputError, UsageError
from ._lamella import Exposure, Layer, LayerStream, Mesh, ScanFigures, ScanStrategy, Stack
from ._looking import plot_groups, plot_values
from ._strategies import StrategyLike, as_strategy
from ._warning import parts_lost, warn

@dataclass(frozen=True)
class ScanLayer:
    """The scan vectors of one layer of a part, exposure by exposure, in the order of execution."""

    index: int  #: index of the layer in the whole plan
    z: float  #: height of the cut, in millimetres
    bottom: float  #: bottom of the material that it represents
    top: float
    exposures: Tuple[Exposure, ...]
    #: One layer for each exposure: contours as rings, each from its first exposed point; hatches as `hatches`.
    layers: Tuple[Layer, ...]
    #: Area of the material of the layer that no vector reaches, in mm2; see `accepted_mm2` of a ScanStrategy.
    unreached_mm2: float = 0.0

    def __post_init__(self) -> None:
        if len(self.layers) != len(self.exposures):
            raise UsageError(
                f"layers: expected {len(self.exposures)}, one for each exposure, found {len(self.layers)}"
            )
        for layer in self.layers:
            if (layer.index, layer.z, layer.bottom, layer.top) != (self.index, self.z, self.bottom, self.top):
                raise UsageError("layers: index, z, bottom and top must be those of the scan layer")

    def __iter__(self) -> Iterator[Tuple[Exposure, Layer]]:
        return zip(self.exposures, self.layers)

    @property
    def vectors(self) -> npt.NDArray[np.float64]:
        """Returns all lines, each from one point to another, in their order: (n, 2, 2), millimetres. The array is a
        copy."""
        lines = [_lines(layer) for layer in self.layers]
        return np.concatenate(lines) if lines else np.empty((0, 2, 2))

    @property
    def exposure(self) -> npt.NDArray[np.int64]:
        """Returns the index of the exposure of each line: (n,)."""
        counts = [len(_lines(layer)) for layer in self.layers]
        return np.repeat(np.arange(len(counts)), counts)

    @property
    def figures(self) -> List[ScanFigures]:
        """Returns the figures of each exposure: lengths, seconds, energy. The beam moves from each exposure to the
        next."""
        return _lamella.measure_vectors(list(self.layers), list(self.exposures))

    @property
    def seconds(self) -> npt.NDArray[np.float64]:
        """Returns the time at which each line ends, with the delay after it, from the start of the layer: (n,). The last
        one is the sum of `build_seconds` of the figures."""
        lines, exposure = self.vectors, self.exposure
        if not len(lines):
            return np.empty(0)
        sets = [part.parameters for part in self.exposures]
        values = np.array([(p.speed_mm_s, p.jump_speed_mm_s, p.mark_delay_us, p.jump_delay_us) for p in sets])[exposure]
        speed, jump_speed, mark_delay, jump_delay = values.T
        jump = np.zeros(len(lines))
        jump[1:] = np.linalg.norm(lines[1:, 0] - lines[:-1, 1], axis=1)
        last = np.ones(len(lines), dtype=bool)  # of its polyline
        last[:-1] = (jump[1:] > 0) | (exposure[1:] != exposure[:-1])
        spent = np.zeros(len(lines))  # a speed of 0 is one that the file does not contain; such moves take no time
        for length, by in ((np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1), speed), (jump, jump_speed)):
            spent += np.divide(length, by, out=np.zeros(len(lines)), where=by > 0)
        return np.cumsum(spent + 1e-6 * (last * mark_delay + (jump > 0) * jump_delay))

    @check.arguments
    def plot(self, axes: Any = None, *, by: Literal["exposure", "region", "order", "time"] = "exposure") -> Any:
        """Draws the vectors into axes of matplotlib, new ones if none are given, and returns the axes. `by` chooses the
        colours: one for each exposure, one for each region, or one that shows the order or the time of the lines. Needs
        matplotlib."""
        if by == "order":
            return plot_values(self.vectors, np.arange(len(self.exposure)), "order of lines", self.z, axes)
        if by == "time":
            return plot_values(self.vectors, self.seconds, "seconds", self.z, axes)
        names = [getattr(exposure, "region" if by == "region" else "name") for exposure in self.exposures]
        kinds = list(dict.fromkeys(names))
        groups = np.array([kinds.index(name) for name in names], dtype=np.int64)[self.exposure]
        return plot_groups(self.vectors, groups, kinds, self.z, axes)


def _lines(layer: Layer) -> npt.NDArray[np.float64]:
    closed = layer.closed
    runs = [np.vstack([ring, ring[:1]]) if closed[i] else ring for i, ring in enumerate(layer)]
    lines = [np.stack([run[:-1], run[1:]], axis=1) for run in runs]
    return np.concatenate([*lines, layer.hatches])


@dataclass(frozen=True)
class ScannedPart:
    """A part whose vectors are made."""

    label: bytes
    support: bool  #: by the strategy's rule for supports, without skins
    bounds: Optional[npt.NDArray[np.float64]]  #: None if they are not known before the layers

    def exposures(self, strategy: ScanStrategy) -> List[Exposure]:
        of_part = _lamella.support_exposures if self.support else _lamella.exposures
        return of_part(strategy, self.label)


class ScanStream(Iterator[ScanLayer]):
    """The result of `scan` for a Stack or a stream: scan layers one by one. `len` of it is the number of layers that are
    left. `write` stores them while they are computed, because the header of the file is known before them."""

    def __init__(
        self,
        scanned: Generator[ScanLayer, None, None],
        source: Union[Stack, LayerStream],
        parts: List[ScannedPart],
        strategy: ScanStrategy,
    ) -> None:
        self._scanned = scanned
        self._first: Optional[ScanLayer] = None
        self._left = len(source)
        #: The bounds of the part of each exposure.
        self.boxes = [
            part.bounds for part in parts if part.bounds is not None for _ in part.exposures(strategy)
        ]
        self.rule = source.rule

    def first(self) -> Optional[ScanLayer]:
        """Returns the next scan layer without taking it; None at the end."""
        if self._first is None:
            self._first = next(self._scanned, None)
        return self._first

    def __next__(self) -> ScanLayer:
        scanned = next(self._scanned) if self._first is None else self._first
        self._first = None
        self._left -= 1
        return scanned

    def close(self) -> None:
        """Ends the stream. May be called more than once."""
        self._first = None
        self._scanned.close()

    def __len__(self) -> int:
        return self._left


@overload
def scan(
    layers: Union[Stack, LayerStream],
    strategy: StrategyLike = None,
    part: Optional[str] = None,
    *,
    support: bool = False,
) -> ScanStream: ...
@overload
def scan(
    layers: Iterable[Layer], strategy: StrategyLike = None, part: Optional[str] = None, *, support: bool = False
) -> Iterator[ScanLayer]: ...
@check.arguments
def scan(
    layers: Iterable[Layer], strategy: StrategyLike = None, part: Optional[str] = None, *, support: bool = False
) -> Iterator[ScanLayer]:
    """Computes scan vectors of layers in ascending z, such as a Stack or a stream from `iter_layers`. Yields them one
    by one, and keeps no more layers than skins need. Skins depend on the layers above and below. For a stream they
    include layers that the options of `iter_layers` leave out; otherwise there is no material above the last layer and
    below the first one. Points of a Stack from a file are left out if they are collinear except for the rounding of the
    file.

    strategy: a ScanStrategy, which is copied; a TOML file, as for the program (needs Python 3.11): a path, bytes or a
        file object; or the same tables as a dict, such as {"hatch": {"distance": 0.08}}. None means the default strategy.
    part: name of the part in exposures; "part" by default. The parts of a plate, and those of a slice file that holds
        several, are scanned one after the other, each with its own label.
    support: scans all parts as supports, by the strategy's rule for supports and without skins. Parts that are supports
        are always scanned like this.

    Pass the result to `write` to store it.

    Raises UsageError for an invalid strategy and for layers that do not ascend, InputError for a Stack that already
    contains scan vectors, LimitError for layers that would have too many vectors. Issues a DefectWarning if layers have
    content of which no vectors are made: hatch lines, open chains, and rings that bound no material because the mesh is
    inside out. For a Stack it is issued at once, for other layers after the last one was taken. Issues another
    DefectWarning if skins need layers of the part that are not in a Stack.
    """
    if check.is_file(layers) or isinstance(layers, Mesh):
        found = "a mesh" if isinstance(layers, Mesh) else "a path" if isinstance(layers, (str, os.PathLike)) else "a file"
        raise TypeError(f"layers: {found} is not taken; slice it first")
    try:
        each = _ascending(iter(layers))
    except TypeError:
        check.refuse_type("layers", "layers in ascending z", layers)
    known = as_strategy("strategy", strategy)
    parts = _parts_to_scan(layers, None if part is None else check.label("part", part), support)
    if isinstance(layers, Stack):
        _check_stack(layers)
        each = iter(list(each))
        warn(f"{layers.path or 'layers'}: {loss}" for loss in _lamella.scan_losses(layers))
        if not all(one.support for one in parts):
            _warn_of_skins(layers, known)
    else:
        each = _told(each, parts)
    scanned = _scan(each, known, parts, layers)
    return ScanStream(scanned, layers, parts, known) if isinstance(layers, (Stack, LayerStream)) else scanned


def _parts_to_scan(layers: Iterable[Layer], label: Optional[bytes], support: bool) -> List[ScannedPart]:
    if isinstance(layers, LayerStream):
        heads = layers._parts
    elif isinstance(layers, Stack):
        heads = [(check.label("label", one.label), one.bounds, one.support) for one in layers.parts]
    else:
        return [ScannedPart(label or b"part", support, None)]
    if len(heads) == 1:
        return [ScannedPart(label or b"part", support or of_support, box) for _, box, of_support in heads]
    if label is not None:
        raise UsageError(f"part: names one part, and the layers hold {len(heads)}, which have labels of their own")
    return [ScannedPart(name or b"part", support or of_support, box) for name, box, of_support in heads]


def _ascending(layers: Iterator[Any]) -> Iterator[Layer]:
    below = None
    for layer in layers:
        if not isinstance(layer, Layer):
            check.refuse_type("layers", "layers", layer)
        if below is not None and not below.z < layer.z:
            raise UsageError(f"layers: must ascend in z: {layer.z:g} mm comes after {below.z:g} mm")
        below = layer
        yield layer


def _check_stack(stack: Stack) -> None:
    """Rejects scan vectors, because they do not describe material: hatches have no contours, and each contour would be
    hatched again."""
    for part in stack.parts:
        if part.exposure is not None:
            raise InputError(
                f"{stack.path}: holds scan vectors already ({part.label}); give the layers that they are made of"
            )


def _warn_of_skins(stack: Stack, strategy: ScanStrategy) -> None:
    if len(stack) == 0 or stack._planned == 0:
        return
    cut_off = {
        "below": strategy.downskin.layers and stack[0].index > 0,
        "above": strategy.upskin.layers and stack[-1].index + 1 < stack._planned,
    }
    sides = " and ".join(side for side, cut in cut_off.items() if cut)
    if sides:
        warn([
            f"layers: those {sides} are not in the stack, and skins are made as if there were no material; scan all layers "
            "and keep some, or scan what iter_layers gives"
        ])  # fmt: skip


def _told(layers: Iterable[Layer], parts: List[ScannedPart]) -> Iterator[Layer]:
    """Yields the layers. At the end, warns of their content of which no vectors are made."""
    losses = _lamella.ScanLosses()
    for layer in layers:
        losses.add(_of_parts(layer, parts))
        yield layer
    warn(f"layers: {loss}" for loss in losses.texts())


def _scan(
    layers: Iterator[Layer], strategy: ScanStrategy, parts: List[ScannedPart], source: Iterable[Layer]
) -> Generator[ScanLayer, None, None]:
    stack = source if isinstance(source, Stack) else None
    exposures = tuple(exposure for part in parts for exposure in part.exposures(strategy))
    skinless = all(part.support for part in parts)
    wanted = (0, 0) if skinless else (strategy.downskin.layers, strategy.upskin.layers)
    # Layers that iter_layers left out affect skins, too.
    beneath, on_top = source._beside(*wanted) if isinstance(source, LayerStream) and any(wanted) else ([], [])
    end = on_top[0] if on_top else None
    layers = chain(layers, on_top)
    below: Deque[Layer] = deque(beneath, maxlen=wanted[0])
    coming: Deque[Layer] = deque(islice(layers, 1 + wanted[1]))
    merged = None
    while coming and coming[0] is not end:
        layer = coming.popleft()
        if merged is None and len(parts) == 1 and (merged := parts_lost([layer])):
            warn([merged])
        vectors: List[Layer] = []
        unreached_mm2 = 0.0
        for part, this, *others in zip(parts, *(_of_parts(one, parts) for one in (layer, *reversed(below), *coming))):
            if part.support:
                of_part, unreached = _lamella.scan_support(this, strategy, stack)
            else:
                beside = others[: len(below)], others[len(below) :]
                of_part, unreached = _lamella.scan(this, *beside, strategy, stack)
            vectors += of_part
            unreached_mm2 += unreached
        yield ScanLayer(layer.index, layer.z, layer.bottom, layer.top, exposures, tuple(vectors), unreached_mm2)
        below.append(layer)
        coming.extend(islice(layers, 1))


def _of_parts(layer: Layer, parts: List[ScannedPart]) -> List[Layer]:
    return layer.parts if len(parts) > 1 else [layer]


@dataclass(frozen=True)
class Geometry:
    """Lines with the attributes of PySLM's HatchGeometry or ContourGeometry."""

    coords: npt.NDArray[np.float64]  #: hatches: (2 n, 2); contours: (n, 2), rings end with their first point
    bid: int  #: number of the build style, which is the number of the exposure, from 1
    mid: int  #: number of the model
    kind: str  #: "contour" or "hatch"

    def numPoints(self) -> int:  # noqa: N802, the name is PySLM's
        """Returns the number of points."""
        return len(self.coords)


@dataclass(frozen=True)
class PyslmLayer:
    """A layer with the attributes and methods of pyslm.geometry.Layer, for its plots, analyses and exporters."""

    layerId: int  # noqa: N815
    z: int  #: micrometres
    geometry: List[Geometry]

    def getGeometry(self) -> List[Geometry]:  # noqa: N802
        """Returns all geometry, in order."""
        return list(self.geometry)

    def getHatchGeometry(self) -> List[Geometry]:  # noqa: N802
        """Returns the hatches."""
        return [one for one in self.geometry if one.kind == "hatch"]

    def getContourGeometry(self) -> List[Geometry]:  # noqa: N802
        """Returns the contours."""
        return [one for one in self.geometry if one.kind == "contour"]

    def getPointsGeometry(self) -> List[Geometry]:  # noqa: N802
        """Returns an empty list: there are no point exposures."""
        return []


@check.arguments
def to_pyslm(layer: ScanLayer, mid: int = 1) -> PyslmLayer:
    """Converts a layer for tools that accept PySLM's layers; PySLM itself is not needed. `mid` is the number of the
    model. Build styles (`bid`) are numbered like the exposures, from 1."""
    if not isinstance(layer, ScanLayer):
        check.refuse_type("layer", "a ScanLayer", layer)
    geometry = []
    for bid, (exposure, vectors) in enumerate(layer, 1):
        if len(vectors.hatches):
            geometry.append(Geometry(vectors.hatches.reshape(-1, 2), bid, mid, "hatch"))
        for ring, closed in zip(vectors, vectors.closed):
            coords = np.vstack([ring, ring[:1]]) if closed else ring
            geometry.append(Geometry(coords, bid, mid, exposure.kind))
    return PyslmLayer(layer.index, round(layer.top * 1000), geometry)
