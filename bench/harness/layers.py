"""Figures of layers from any slicer, and the agreement of two slicers."""

import math
from dataclasses import dataclass, replace
from typing import Optional


@dataclass
class Layer:
    z: float  # of the cut, mm above the bottom of the part
    contours: int
    area_mm2: Optional[float] = None
    perimeter_mm: Optional[float] = None


@dataclass
class Agreement:
    layers: int  # of both slicers
    missing: int  # of only one slicer
    same_count: int  # layers with equal numbers of contours
    contours: int  # of the other slicer, in total
    expected_contours: int
    area_off: Optional[float]  # sum of the differences / sum of areas
    perimeter_off: Optional[float]
    lowered: int = 0  # number of layers by which the other slicer lowers the part

    @property
    def exact(self):
        """Returns whether all layers have equal numbers of contours, and areas and lengths differ by less than 1e-5."""
        return (self.missing == 0 and self.lowered == 0 and self.same_count == self.layers and self.measured()
                and all(off is None or off < 1e-5 for off in (self.area_off, self.perimeter_off)))

    @property
    def near(self):
        """Returns whether only the rounding and simplification of tool-path programs separates the layers: at most one
        layer (or 1%) more or less, and at most 1% of the contours, areas and lengths."""
        return (self.layers > 0 and self.missing <= max(1, 0.01 * self.layers) and self.measured()
                and abs(self.contours - self.expected_contours) <= 0.01 * self.expected_contours
                and all(off is None or off < 0.01 for off in (self.area_off, self.perimeter_off)))

    def measured(self):
        return self.area_off is not None or self.perimeter_off is not None

    def text(self):
        if self.exact:
            return "equal"
        parts = []
        if self.lowered:
            parts.append("stands one layer lower" if self.lowered == 1 else f"stands {self.lowered} layers lower")
        if self.missing:
            parts.append("one layer more or less" if self.missing == 1 else f"{self.missing} layers more or less")
        if self.same_count != self.layers:
            parts.append(f"{self.contours:,} contours for {self.expected_contours:,}")
        for name, off in (("areas", self.area_off), ("lengths", self.perimeter_off)):
            if off is not None:
                parts.append(f"{name} off by {100 * off:.2g}%")
        return ", ".join(parts)


def agreement(found, expected, layer_height=None):
    """Compares by height, to 0.001 mm. Some programs omit the lowest layers if no wall fits into them, and lower the
    rest: with `layer_height`, layers are also compared one and two layers higher, and the closest comparison counts."""
    if layer_height is None or not found:
        return agreement_as_it_stands(found, expected)
    tries = []
    for lowered in range(3):
        raised = [replace(layer, z=layer.z + lowered * layer_height) for layer in found]
        tries.append(replace(agreement_as_it_stands(raised, expected), lowered=lowered))
    return min(tries, key=lambda one: math.inf if one.area_off is None else one.area_off)


def agreement_as_it_stands(found, expected):
    by_height = {round(layer.z, 3): layer for layer in expected}
    pairs = [(layer, by_height[round(layer.z, 3)]) for layer in found if round(layer.z, 3) in by_height]
    return Agreement(
        layers=len(pairs),
        missing=max(len(found), len(expected)) - len(pairs),
        same_count=sum(mine.contours == theirs.contours for mine, theirs in pairs),
        contours=sum(mine.contours for mine, _ in pairs),
        expected_contours=sum(theirs.contours for _, theirs in pairs),
        area_off=relative_difference([(mine.area_mm2, theirs.area_mm2) for mine, theirs in pairs]),
        perimeter_off=relative_difference([(mine.perimeter_mm, theirs.perimeter_mm) for mine, theirs in pairs]))


def relative_difference(pairs):
    pairs = [(a, b) for a, b in pairs if a is not None and b is not None]
    total = sum(abs(b) for _, b in pairs)
    return sum(abs(a - b) for a, b in pairs) / total if total else None
