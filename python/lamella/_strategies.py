"""Scan strategies of files and of dicts."""

from __future__ import annotations

import copy
from typing import Any, Dict, List, Mapping, Optional, Union

from . import _arguments as check
from . import _lamella
from ._arguments import Readable
from ._errors import UsageError
from ._lamella import ContourRule, HatchRule, ParameterSet, ScanStrategy, SkinRule, SupportRule

StrategyLike = Union[ScanStrategy, Mapping[str, Any], Readable, None]


def as_strategy(name: str, strategy: StrategyLike) -> ScanStrategy:
    """Returns a copy of the strategy, so that later changes of the given object have no effect."""
    if strategy is None:
        return ScanStrategy()
    if isinstance(strategy, ScanStrategy):
        found = copy.copy(strategy)
    elif isinstance(strategy, Mapping):
        found = _from_tables(name, strategy)
    elif isinstance(strategy, str) and "\n" in strategy:
        raise UsageError(
            f"{name}: expected the path of a file, found a text of several lines; ScanStrategy.from_toml takes it"
        )
    elif check.is_file(strategy):
        path, text = check.content(name, strategy)
        found = _from_tables(path, _toml(path, text))
    else:
        check.refuse_type(name, "a ScanStrategy, a TOML file, or a dict of tables", strategy)
    _lamella.check_strategy(found)
    return found


def _toml(path: str, text: bytes) -> Dict[str, Any]:
    try:
        import tomllib
    except ImportError as error:
        raise ImportError("strategies as files need Python 3.11; a dict of the same tables will do") from error
    try:
        return tomllib.loads(text.decode("utf-8-sig"))  # skips a byte order mark
    except ValueError as error:
        raise UsageError(f"{path}: {error}") from error


def _from_tables(name: str, tables: Mapping[str, Any]) -> ScanStrategy:
    """Makes a strategy of the tables of a strategy file, any of which may be missing."""
    strategy = ScanStrategy()
    rules: List[Union[ContourRule, HatchRule]] = [
        strategy.contours, strategy.hatch, strategy.upskin.hatch, strategy.downskin.hatch,
        strategy.support.contours, strategy.support.hatch,
    ]  # fmt: skip
    sets = {rule.parameters.name: ParameterSet(rule.parameters) for rule in rules}
    parameters = tables.get("parameters", {})
    for label, table in _items(f"{name}: parameters", parameters):
        place = f"{name}: parameters.{check.excerpt(label)}"
        chosen = sets.setdefault(check.text(f"{name}: parameters", label), _named(label))
        _assign(place, chosen, table)
    _assign(name, strategy, {key: value for key, value in tables.items() if key != "parameters"}, sets)
    used = [rule.parameters.name for rule in rules]
    for label in parameters:
        if label not in used:
            raise UsageError(f"{name}: the parameters {check.excerpt(label)} are used nowhere; there are {', '.join(used)}")
    for rule in rules:
        rule.parameters = sets[rule.parameters.name]
    return strategy


def _named(label: str) -> ParameterSet:
    parameters = ParameterSet()
    parameters.name = label
    return parameters


def _items(name: str, table: Any) -> Any:
    if not isinstance(table, Mapping):
        check.refuse_type(name, "a table", table)
    return table.items()


def _assign(name: str, rule: Any, table: Any, sets: Optional[Dict[str, ParameterSet]] = None) -> None:
    # Parameter sets are named by the keys of their tables.
    known = [key for key in dir(type(rule)) if not key.startswith("_") and key != "name"]
    before = f"{name}: " if isinstance(rule, ScanStrategy) else f"{name}."
    for key, value in _items(name, table):
        if key not in known:
            near = check.nearest(key, known)
            hint = f"did you mean {near}?" if near else f"there are {', '.join(known)}"
            raise UsageError(f"{name}: there is no {check.excerpt(key)}; {hint}")
        place = f"{before}{key}"
        if key == "parameters" and sets is not None:
            if not check.text(place, value):
                raise UsageError(f"{place}: expected the name of parameters, found an empty text")
            if value not in sets:
                raise UsageError(f"{place}: there are no parameters {check.excerpt(value)}; there are {check.excerpt(', '.join(sets))}")
            rule.parameters = sets[value]
        elif isinstance(getattr(rule, key), (ContourRule, HatchRule, SkinRule, SupportRule)):
            _assign(place, getattr(rule, key), value, sets)
        else:
            try:
                setattr(rule, key, value)
            except (TypeError, UsageError) as error:  # its text begins with the key
                raise type(error)(f"{before}{error}") from None
