"""Warnings that refer to the line of the caller, from any depth inside the package."""

from __future__ import annotations

import sys
import warnings
from typing import TYPE_CHECKING, Iterable, Optional, Type

from ._errors import DefectWarning, one_line

if TYPE_CHECKING:
    from ._lamella import Layer


#: Names in Python for fields that texts of the library mention.
ARGUMENTS = {
    "`snap_mm` ": "snap=",
    "`close_gaps_mm` ": "close_gaps=",
    "`include` ": "include=",
    "`orient`": "orient=True",
    "`offset_mm`, `min_area_mm2` or `fill`": "fill or bottom_offset",
    "converting them with `fill` nonzero": 'filled("nonzero")',
}


def parts_lost(layers: Iterable[Layer]) -> Optional[str]:
    """Returns what a warning says of layers of plates that are taken alone, None if there are none."""
    count = sum(len(layer.parts) > 1 for layer in layers)
    if count == 0:
        return None
    of_plates = f"{count} layers of plates lose" if count > 1 else "a layer of a plate loses"
    return f"{of_plates} the labels and roles of the parts, which become one; take each of `parts` of the stack instead"


def with_arguments(text: str) -> str:
    for field, argument in ARGUMENTS.items():
        text = text.replace(field, argument)
    return text


def warn(texts: Iterable[str], category: Type[Warning] = DefectWarning) -> None:
    """Issues a warning for each text."""
    package = __name__.rpartition(".")[0]
    level = 1
    frame = sys._getframe(0)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    for text in texts:
        warnings.warn(one_line(with_arguments(text)), category, stacklevel=level)
