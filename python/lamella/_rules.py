"""What Python adds to the extension's classes of scan strategies. The extension takes it from here while it makes these
classes, so this module does without the extension."""

from __future__ import annotations

import inspect
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Tuple

from . import _arguments as check
from ._errors import UsageError

if TYPE_CHECKING:
    from ._lamella import ScanStrategy as _ScanStrategy
else:
    _ScanStrategy = object


def tables_of(path: str, text: bytes) -> Dict[str, Any]:
    try:
        import tomllib
    except ImportError as error:
        raise ImportError("TOML files need Python 3.11; a dict of the same tables will do") from error
    try:
        return tomllib.loads(text.decode("utf-8-sig"))  # skips a byte order mark
    except ValueError as error:
        raise UsageError(f"{path}: {error}") from error


class ScanStrategy(_ScanStrategy):
    @classmethod
    def from_toml(cls, source: check.Readable) -> _ScanStrategy:
        """Returns the strategy of a TOML file (needs Python 3.11): a path, bytes, a file object, or the text itself, as
        `to_toml` returns it. A str with an equals sign or a line end is a text. Fields that are absent have their
        defaults.

        Raises InputError for a file that cannot be read, UsageError for anything that a strategy does not have."""
        if isinstance(source, str) and any(sign in source for sign in "=\n\r"):
            source = source.encode()
        if not check.is_file(source):
            check.refuse_type("source", "a path, bytes, a binary file, or the text of a TOML file", source)
        path, text = check.content("source", source)
        return cls._of_tables(os.fsencode(path), tables_of(path, text))

    def to_toml(self) -> str:
        """Returns the whole strategy as the text of a TOML file, with comments, which `scan` and the program read."""
        self._check()
        return self._text()

    def __str__(self) -> str:
        return self._text()


def _attributes(base: type, rule: Any) -> Dict[str, Any]:
    """Returns the attributes that the class of the package has, without those of derived classes."""
    return {name: getattr(rule, name) for name, member in vars(base).items() if isinstance(member, property)}


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


def _shows_its_attributes(cls: type) -> None:
    def __repr__(self: Any) -> str:
        shown = ", ".join(f"{name}={value!r}" for name, value in _attributes(cls, self).items())
        return f"{type(self).__name__}({shown})"

    setattr(cls, "__repr__", __repr__)


def _is_made_of_its_attributes(cls: type) -> None:
    """Makes a class of strategies take its attributes as keywords. A ParameterSet also takes another one to copy."""
    make: Callable[..., None] = getattr(cls, "__init__")
    defaults = getattr(cls, "__new__")(cls)
    make(defaults)
    copies = cls.__name__ == "ParameterSet"
    self_of_init = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    parameters = [self_of_init]
    if copies:
        parameters.append(inspect.Parameter("other", inspect.Parameter.POSITIONAL_OR_KEYWORD, default=None))
    for name, value in _attributes(cls, defaults).items():
        parameters.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=value))
    known = [parameter.name for parameter in parameters]

    def __init__(self: Any, *others: Any, **attributes: Any) -> None:
        if len(others) > copies:
            raise TypeError(f"{cls.__name__}() takes its attributes as keywords only")
        other = others[0] if others else attributes.pop("other", None) if copies else None
        if other is not None and not isinstance(other, cls):
            check.refuse_type("other", f"a lamella.{cls.__name__}", other)
        make(self, *(() if other is None else (other,)))
        for name, value in attributes.items():
            if name not in known[1:]:
                raise TypeError(f"{cls.__name__}() got an unexpected keyword argument {name!r}")
            setattr(self, name, value)

    __init__.__qualname__ = f"{cls.__name__}.__init__"  # the name in its errors
    setattr(__init__, "__signature__", inspect.Signature(parameters))
    setattr(cls, "__init__", check.arguments(__init__))
    check.show_signature(cls)


def complete(cls: type) -> None:
    """Completes a class of strategies, or that of figures, which are not made by users."""
    if cls.__name__ != "ScanFigures":
        _is_made_of_its_attributes(cls)
        _is_its_attributes(cls)
    _shows_its_attributes(cls)
    if cls.__name__ == "ScanStrategy":
        check.give_methods(cls, ScanStrategy)
