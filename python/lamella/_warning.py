"""Warnings that point at the line of the caller, however deep inside the package they come from."""

from __future__ import annotations

import sys
import warnings
from typing import Iterable

from ._errors import DefectWarning


def warn(texts: Iterable[str]) -> None:
    """Issues a DefectWarning for each text."""
    package = __name__.rpartition(".")[0]
    level = 1
    frame = sys._getframe(0)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
        level += 1
    for text in texts:
        warnings.warn(text, DefectWarning, stacklevel=level)
