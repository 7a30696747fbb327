"""Results of the check of a print. Like `_methods`, this module does without the extension."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, NamedTuple, Tuple

import numpy as np
import numpy.typing as npt


class PrintIsland(NamedTuple):
    """Material that begins in a layer without material below it, until it joins material that stands on the plate, or an
    island that began lower. Lengths are in millimetres."""

    layer: int  #: index of its first layer
    bottom: float  #: of the first layer
    top: float  #: of the last layer before it joins
    centre: Tuple[float, float]  #: centroid in the first layer
    area: float  #: mm^2, in the first layer
    largest_area: float  #: mm^2, the largest in a layer
    volume: float  #: mm^3, the sum of area times thickness
    joins: bool  #: False if it is still separate where it ends
    support: bool  #: whether its first layer is mostly material of supports


class PrintCavity(NamedTuple):
    """Space that material encloses in each of its layers, and that is not connected with the space outside through layers
    below. Lengths are in millimetres."""

    layer: int  #: index of its first layer
    bottom: float  #: of the first layer
    top: float  #: of the last layer in which it is enclosed
    centre: Tuple[float, float]  #: centroid in the first layer
    area: float  #: mm^2, in the first layer
    largest_area: float  #: mm^2, the largest in a layer
    volume: float  #: mm^3, the sum of area times thickness
    opens: bool  #: whether it joins the space outside above its last layer
    on_plate: bool  #: whether the plate closes it from below

    @property
    def trap(self) -> bool:
        """Whether it never opens, so that resin stays in it. Other cavities are cups: while they are printed, lifting the
        plate makes a vacuum in them."""
        return not self.opens and not self.on_plate


@dataclass(frozen=True)
class PrintCheck:
    """Findings of `Stack.check`. They are true if they are `ok`. Arrays have a number for each layer: (layers,) float64."""

    ok: bool  #: no islands, cups, traps and empty layers
    islands: List[PrintIsland]  #: by ascending layer
    cavities: List[PrintCavity]  #: by ascending layer
    area: npt.NDArray[np.float64]  #: mm^2
    largest_area: npt.NDArray[np.float64]  #: mm^2, the largest connected area
    perimeter: npt.NDArray[np.float64]  #: mm
    exposed: npt.NDArray[np.float64]  #: mm^2 without material in the layer below
    overhang_area: npt.NDArray[np.float64]  #: mm^2 that the layer below does not carry, without islands
    overhang_width: npt.NDArray[np.float64]  #: mm, the largest distance of such a point from the material below
    empty_layers: int  #: layers without material between layers with material
    findings: List[str]  #: one line for each kind of finding, with the first location

    def __bool__(self) -> bool:
        return self.ok
