"""Layers as figures, whoever cut them, and how far two slicers agree."""

from dataclasses import dataclass
from typing import Optional


@dataclass
class Layer:
    z: float  # of the cut, mm from the bottom of the part
    contours: int
    area_mm2: Optional[float] = None
    perimeter_mm: Optional[float] = None


@dataclass
class Agreement:
    layers: int  # that both have
    missing: int  # that only one of the two has
    same_count: int  # layers with as many contours
    contours: int  # of the other slicer, in all
    expected_contours: int
    area_off: Optional[float]  # sum of the differences over sum of areas
    perimeter_off: Optional[float]

    @property
    def exact(self):
        """As many contours in every layer, and areas and lengths that differ by less than one in
        100,000."""
        return (self.missing == 0 and self.same_count == self.layers and self.measured()
                and all(off is None or off < 1e-5 for off in (self.area_off, self.perimeter_off)))

    @property
    def near(self):
        """What the rounding and thinning of tool-path programs leave of the same layers: one layer more or less at the
        top, the number of contours within one in a hundred, areas or lengths within one in a hundred."""
        return (self.layers > 0 and self.missing <= 1 and self.measured()
                and abs(self.contours - self.expected_contours) <= 0.01 * self.expected_contours
                and all(off is None or off < 0.01 for off in (self.area_off, self.perimeter_off)))

    def measured(self):
        return self.area_off is not None or self.perimeter_off is not None

    def text(self):
        if self.exact:
            return "equal"
        parts = []
        if self.missing:
            parts.append("one layer more or less" if self.missing == 1 else f"{self.missing} layers more or less")
        if self.same_count != self.layers:
            parts.append(f"{self.contours:,} contours for {self.expected_contours:,}")
        for name, off in (("areas", self.area_off), ("lengths", self.perimeter_off)):
            if off is not None:
                parts.append(f"{name} off by {100 * off:.2g}%")
        return ", ".join(parts)


def agreement(found, expected):
    """Compares by height, to a thousandth of a millimetre."""
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
