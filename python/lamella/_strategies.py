"""Scan strategies of files and of dicts."""

from __future__ import annotations

import copy
import os
from typing import Any, Mapping, Union

from . import _arguments as check
from ._arguments import Readable
from ._errors import UsageError
from ._lamella import ScanStrategy
from ._rules import tables_of

StrategyLike = Union[ScanStrategy, Mapping[str, Any], Readable, None]


def as_strategy(name: str, strategy: StrategyLike) -> ScanStrategy:
    """Returns a copy of the strategy, so that later changes of the given object have no effect."""
    if strategy is None:
        return ScanStrategy()
    if isinstance(strategy, ScanStrategy):
        found = copy.copy(strategy)
        found._check()
        return found
    if isinstance(strategy, Mapping):
        return ScanStrategy._of_tables(name.encode(), strategy)
    if isinstance(strategy, str) and "\n" in strategy:
        raise UsageError(
            f"{name}: expected the path of a file, found a text of several lines; ScanStrategy.from_toml takes it"
        )
    if check.is_file(strategy):
        path, text = check.content(name, strategy)
        return ScanStrategy._of_tables(os.fsencode(path), tables_of(path, text))
    check.refuse_type(name, "a ScanStrategy, a TOML file, or a dict of tables", strategy)
