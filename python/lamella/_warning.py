"""Warnings that refer to the line of the caller, from any depth inside the package."""

from __future__ import annotations

import sys
import warnings
from typing import Iterable, Type

from ._errors import DefectWarning, one_line


#: Names in Python for fields that texts of the library mention.
ARGUMENTS = {
    "`snap_mm` ": "snap=",
    "`close_gaps_mm` ": "close_gaps=",
    "`include` ": "include=",
    "`orient`": "orient=True",
    "`offset_mm`, `min_area_mm2` or `fill`": "fill",
    "converting them with `fill` nonzero": 'filled("nonzero")',
}


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
