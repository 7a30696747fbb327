"""Checks of arguments before the work begins.

A wrong type is a TypeError, a wrong value a UsageError, which is a ValueError. The text contains the name of the
argument, the value found, and a description of the value expected.
"""

from __future__ import annotations

import decimal
import difflib
import functools
import gzip
import inspect
import io
import math
import numbers
import operator
import os
import re
import reprlib
from typing import (
    Annotated, Any, Callable, Dict, Iterable, Literal, Match, NoReturn, Optional, Protocol, Sequence, Tuple, TypeVar, Union,
    get_args, get_origin,
)  # fmt: skip

import numpy as np
import numpy.typing as npt

from ._errors import Error, OutputError, UsageError, error_of, name_the_file, printable


class BinaryReader(Protocol):
    """A file object that is open for reading bytes, such as an io.BytesIO."""

    def read(self) -> bytes:
        """Returns the bytes from its position to its end."""


class BinaryWriter(Protocol):
    """A file object that is open for writing bytes, such as an io.BytesIO."""

    def write(self, content: memoryview, /) -> object:
        """Writes the bytes at its position. May return the number of written ones."""


PathLike = Union[str, "os.PathLike[str]", "os.PathLike[bytes]"]
Readable = Union[PathLike, bytes, bytearray, memoryview, BinaryReader]
Writable = Union[PathLike, BinaryWriter]
# For the extension: the bytes of a path, or the name of an object in errors and its content.
Source = Union[bytes, Tuple[bytes, Union[bytes, bytearray, memoryview]]]
CutAt = Literal["bottom", "middle", "top"]
FillRule = Literal["nonzero", "evenodd", "positive"]
Corners = Literal["mitre", "bevel", "round"]
Orientation = Literal["landscape", "portrait"]
Mirror = Literal["none", "x", "y", "xy"]
Vector = Union[Sequence[float], npt.NDArray[Any]]  # x, y and z
Rule = Literal["section_above", "section_below"]
Check = Callable[[str, Any], Any]  # takes the name of an argument and its value
T = TypeVar("T")
Class = TypeVar("Class", bound=type)
Function = TypeVar("Function", bound=Callable[..., Any])

MOST_PIXELS = 65535  # of an image, each way
SIMILAR = 0.65  # least similarity of words, by difflib; that of "side" and "middle" is 0.6
MOST_QUOTED = 200  # characters of a value; the library quotes as many bytes


def excerpt(value: object) -> str:
    """Returns the value as text in printable form, truncated for errors."""
    text = printable(str(value)[: MOST_QUOTED + 1])
    return text if len(text) <= MOST_QUOTED else f"{text[:MOST_QUOTED]}..."


def described(value: object) -> str:
    """Describes a value in a few words."""
    if isinstance(value, np.ndarray):
        return f"{value.shape} of {excerpt(value.dtype)}"
    if isinstance(value, (str, bytes)):
        return reprlib.repr(value)
    if value is None or isinstance(value, numbers.Number):
        try:
            return excerpt(value)
        except ValueError:  # Python does not convert integers of thousands of digits
            return "a number of thousands of digits"
    return f"an object of type {excerpt(type(value).__name__)}"


def refuse_type(name: str, expected: str, value: object) -> NoReturn:
    raise TypeError(f"{name}: expected {expected}, found {described(value)}")


def refuse_value(name: str, expected: str, value: object) -> NoReturn:
    raise UsageError(f"{name}: {described(value)} is not possible; expected {expected}")


def has_masked_entries(value: Any) -> bool:
    return bool(np.ma.is_masked(value))  # type: ignore[no-untyped-call]


def is_array_of_one(value: Any) -> bool:
    """Returns whether a value is an array without dimensions, that is, of one number, and not masked."""
    return isinstance(value, np.ndarray) and value.ndim == 0 and not has_masked_entries(value)


def is_number(value: Any) -> bool:
    """Returns whether a value is meant as one number."""
    return isinstance(value, (numbers.Real, decimal.Decimal)) or is_array_of_one(value)


def number(
    name: str, value: Any, *, above: float = -math.inf, least: float = -math.inf, expected: str = "a finite number"
) -> float:
    if is_array_of_one(value):
        value = value.item()
    if not isinstance(value, (numbers.Real, decimal.Decimal)) or isinstance(value, bool):
        refuse_type(name, expected, value)
    try:
        found = float(value)
    except (ValueError, OverflowError):  # a signalling Decimal, or an integer that is too large
        found = math.nan
    if not (math.isfinite(found) and found > above and found >= least):
        refuse_value(name, expected, value)
    return found


def positive(name: str, value: Any) -> float:
    return number(name, value, above=0, expected="a number above 0")


def distance(name: str, value: Any) -> float:
    return number(name, value, least=0, expected="a distance, which is not negative")


def whole(name: str, value: Any, least: int = 0, most: int = 2**64 - 1) -> int:
    expected = f"a whole number from {least} to {most}" if most < 2**63 else f"a whole number, {least} or more"
    if isinstance(value, (bool, np.bool_)):
        refuse_type(name, expected, value)
    try:
        found = operator.index(value)
    except TypeError:
        refuse_type(name, expected, value)
    if not least <= found <= most:
        refuse_value(name, expected, found)
    return found


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        refuse_type(name, "True or False", value)
    return bool(value)


def text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        refuse_type(name, "a text", value)
    _encoded(name, value)
    return value


def choice(name: str, value: Any, choices: Sequence[str]) -> str:
    if not isinstance(value, str):
        refuse_type(name, _listed(choices, "or"), value)
    if value not in choices:
        hint = nearest(value, choices)
        raise UsageError(
            f'{name}: "{excerpt(value)}" is none of {_listed(choices, "and")}' + (f'; did you mean "{hint}"?' if hint else "")
        )
    return value


def nearest(word: object, known: Iterable[str]) -> str:
    """Returns the known word that is probably meant, or "" if none is similar."""
    return next(iter(difflib.get_close_matches(excerpt(word).lower(), list(known), 1, SIMILAR)), "")


def arguments(function: Function) -> Function:
    """Checks the arguments of a function, which gets them as the checks return them. The types of its parameters say what
    they may be: `bool`, `int`, `float`, `str`, a Literal, Annotated with a check, and an Optional of these. Others are not
    checked here. To the error for an unknown keyword it adds the one that is probably meant, and to an error of the system
    the name of the file."""
    parameters = inspect.signature(function).parameters
    names = getattr(function, "__globals__")
    checks = [(name, _check_of(_type_of(parameter.annotation, names))) for name, parameter in parameters.items()]
    by_name = {name: of_value for name, of_value in checks if of_value is not None}
    defaults = [
        (position, name, by_name[name](name, parameters[name].default))
        for position, name in enumerate(parameters)
        if name in by_name and parameters[name].default is not inspect.Parameter.empty
    ]
    changed = [(position, name, value) for position, name, value in defaults if value != parameters[name].default]

    most_given = sum(parameter.kind != parameter.KEYWORD_ONLY for parameter in parameters.values())

    @functools.wraps(function)
    def call(*given: Any, **keywords: Any) -> Any:
        for word in keywords:
            if word not in parameters and (hint := nearest(word, parameters)):
                raise TypeError(
                    f"{function.__qualname__}() got an unexpected keyword argument {word!r}; did you mean {hint!r}?"
                )
        if len(given) > most_given or not parameters.keys() >= keywords.keys():
            return function(*given, **keywords)  # raises Python's error
        checked = [of_value(name, value) if of_value else value for (name, of_value), value in zip(checks, given)]
        named = {name: by_name[name](name, value) if name in by_name else value for name, value in keywords.items()}
        for position, name, value in changed:
            if len(given) <= position and name not in keywords:
                named[name] = value
        try:
            return function(*checked, **named)
        except OSError as error:
            if isinstance(error, Error):
                name_the_file(error, (*given, *keywords.values()))
            raise

    shown = [parameter.replace(annotation=plain(parameter.annotation, names)) for parameter in parameters.values()]
    signature = inspect.signature(function)
    returned = plain(signature.return_annotation, names)
    setattr(call, "__signature__", signature.replace(parameters=shown, return_annotation=returned))
    return call  # type: ignore[return-value]


def construction(cls: Class) -> Class:
    """Checks the arguments of the constructor of a class."""
    setattr(cls, "__init__", arguments(getattr(cls, "__init__")))
    return cls


def give_methods(cls: type, source: type) -> None:
    """Gives a class the functions of another one, which check their arguments. Its own constructor becomes `_make`."""
    for name, method in vars(source).items():
        if name == "__init__":
            setattr(cls, "_make", getattr(cls, "__init__"))
        if isinstance(method, classmethod):
            setattr(cls, name, classmethod(arguments(method.__func__)))
        elif callable(method):
            takes_keywords = name == "__init__" or not name.startswith("_")
            setattr(cls, name, arguments(method) if takes_keywords else method)
    if "__init__" in vars(source):
        show_signature(cls)


def show_signature(cls: type) -> None:
    """Shows editors the arguments of a class of the extension, which its metaclass hides."""
    signature = inspect.signature(getattr(cls, "__init__"))
    setattr(cls, "__signature__", signature.replace(parameters=list(signature.parameters.values())[1:]))


def _type_of(annotation: Any, names: Dict[str, Any]) -> Any:
    try:
        return eval(annotation, names) if isinstance(annotation, str) else annotation
    except (AttributeError, NameError, SyntaxError):  # a name that is there for type checkers only, or part of a text
        return Any


def _check_of(kind: Any) -> Optional[Check]:
    """Returns the check of a value of this type."""
    origin, inner = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return inner[1]  # type: ignore[no-any-return]
    if origin is Literal:
        return lambda name, value: choice(name, value, inner)
    if origin is Union and inner[1:] == (type(None),):
        each = _check_of(inner[0])
        return None if each is None else functools.partial(optional, each)
    checks: Dict[Any, Check] = {bool: flag, int: whole, float: number, str: text}
    return checks.get(kind)


def plain(annotation: Any, names: Dict[str, Any]) -> Any:
    """Returns the text of a type without its checks, as users see it."""

    def known(found: Match[str]) -> str:
        kind = _type_of(found.group(), names)
        if get_origin(kind) is Annotated:
            text = repr(get_args(kind)[0]).replace("typing.", "").replace("<class '", "").replace("'>", "")
            if len(text) < 40:
                return text
        return found.group().replace("check.", "").lstrip("_")

    return re.sub(r"[\w.]+", known, annotation) if isinstance(annotation, str) else annotation


def _listed(choices: Sequence[str], last: str) -> str:
    quoted = [f'"{word}"' for word in choices]
    return f"{', '.join(quoted[:-1])} {last} {quoted[-1]}"


def label(name: str, value: Any) -> bytes:
    """Returns the bytes of a text, which need not be UTF-8, because it may come from a file."""
    return _encoded(name, text(name, value))


def is_file(value: Any) -> bool:
    """Returns whether a value is what `source` takes: a path, bytes or a file object. Meshes of other packages may have
    a method `read`, too, which takes a path."""
    if isinstance(value, (str, os.PathLike, bytes, bytearray, memoryview)):
        return True
    return callable(getattr(value, "read", None)) and not any(hasattr(value, name) for name in ("points", "vertices", "vectors"))


def source(name: str, value: Any) -> Source:
    """Returns a file to read. The content of a file object is read."""
    if not is_file(value):
        refuse_type(name, "a path (str or os.PathLike), bytes or a binary file", value)
    if isinstance(value, (str, os.PathLike)):
        return _path(name, value)
    if isinstance(value, memoryview) and not value.c_contiguous:
        return _name_of(name, value), value.tobytes()
    if isinstance(value, (bytes, bytearray, memoryview)):
        return _name_of(name, value), value
    _refuse_text_file(name, value, "rb")
    content = value.read()
    if not isinstance(content, (bytes, bytearray, memoryview)):
        refuse_type(name, "a binary file, which gives bytes", content)
    if not content:
        known = os.fsdecode(_name_of(name, value))
        raise error_of("InputError", f"{known}: holds nothing at its position; seek(0) goes to its beginning")
    return _name_of(name, value), content


def content(name: str, value: Any) -> Tuple[str, bytes]:
    """Returns the name of a file in errors, and all its bytes."""
    found = source(name, value)
    if isinstance(found, tuple):
        return os.fsdecode(found[0]), bytes(found[1])
    known = os.fsdecode(found)
    try:
        with open(found, "rb") as file:
            return known, file.read()
    except OSError as error:
        missing = isinstance(error, (FileNotFoundError, NotADirectoryError))
        text = "there is no such file" if missing else f"cannot be read: {error.strerror}"
        raise error_of("InputError", f"{known}: {text}", error.errno or 0) from None


def target(name: str, value: Any) -> Tuple[bytes, Optional[BinaryWriter]]:
    """Returns the path of a file to write and None, or the name of a file object in errors and the object."""
    if isinstance(value, (str, os.PathLike)):
        return _path(name, value), None
    if not callable(getattr(value, "write", None)):
        refuse_type(name, "a path (str or os.PathLike) or a binary file", value)
    _refuse_text_file(name, value, "wb")
    known = _name_of(name, value)
    if known.lower().endswith(b".gz") and not isinstance(value, gzip.GzipFile):
        raise UsageError(f"{name}: {os.fsdecode(known)} would not be compressed; give its path, or open it with gzip.open")
    return known, value


def put(file: BinaryWriter, content: bytes) -> None:
    """Writes all bytes to a file object, which may write some of them at a time."""
    rest = memoryview(content)
    while rest:
        written = file.write(rest)
        if written is None and not isinstance(file, io.RawIOBase):
            return  # as objects that only collect do
        if not isinstance(written, int) or not 0 < written <= len(rest):
            raise OutputError(f"{os.fsdecode(_name_of('file', file))}: its write() returned {written}, for {len(rest)} bytes")
        rest = rest[written:]


def _refuse_text_file(name: str, value: Any, mode: str) -> None:
    if isinstance(value, io.TextIOBase):
        raise TypeError(f'{name}: expected a binary file, found one of text; open it with the mode "{mode}"')


def _name_of(name: str, value: Any) -> bytes:
    """Returns the name of an object in errors: that of a file if it has one, otherwise its type."""
    known = getattr(value, "name", None)
    if isinstance(known, bytes):
        known = os.fsdecode(known)
    return _encoded(name, known if isinstance(known, str) and known else f"<{type(value).__name__}>")


def _path(name: str, value: Any) -> bytes:
    plain = os.fspath(value)
    found = plain if isinstance(plain, bytes) else _encoded(name, plain)
    if not found:
        raise UsageError(f"{name}: expected the path of a file, found an empty one")
    if b"\0" in found:
        raise UsageError(f"{name}: {excerpt(repr(plain))} is not possible; the path of a file holds no null character")
    return found


def _encoded(name: str, value: str) -> bytes:
    try:
        return os.fsencode(value)
    except UnicodeError:
        raise UsageError(f"{name}: {excerpt(repr(value))} is not possible; expected characters that UTF-8 has") from None


def several(
    name: str, value: Any, count: Optional[int], expected: str, each: Callable[[str, Any], T]
) -> Tuple[T, ...]:
    """Returns the checked items. There must be `count` of them; None permits any number."""
    if isinstance(value, (str, bytes)):
        refuse_type(name, expected, value)
    try:
        items = tuple(value)
    except TypeError:
        refuse_type(name, expected, value)
    if count is not None and len(items) != count:
        raise UsageError(f"{name}: expected {expected}, found {len(items)} {'value' if len(items) == 1 else 'values'}")
    return tuple(each(name, item) for item in items)


def pair(name: str, value: Any, expected: str, each: Callable[[str, Any], T]) -> Tuple[T, T]:
    first, second = several(name, value, 2, expected, each)
    return first, second


def coordinates(name: str, value: Any) -> Tuple[float, ...]:
    return several(name, value, 3, "three numbers (x, y, z)", number)


def lengths(name: str, value: Any) -> Tuple[float, float]:
    """Returns two lengths, along x and y. One length counts for both."""
    if is_number(value):
        return (positive(name, value),) * 2
    return pair(name, value, "one length, or two (x, y)", positive)


def inset_and_height(name: str, value: Any) -> Tuple[float, float]:
    return pair(name, value, "two lengths above 0 (inset, height)", positive)


def optional(check: Callable[..., T], name: str, value: Any, *more: Any) -> Optional[T]:
    """Returns None for None, otherwise the result of the check."""
    return None if value is None else check(name, value, *more)


def array(name: str, value: Any, expected: str, kinds: str = "fiu") -> npt.NDArray[Any]:
    """Returns an array of numbers; only of integers if `kinds` is "iu"."""
    if value is None or isinstance(value, (str, bytes, dict, set)):
        refuse_type(name, expected, value)
    if has_masked_entries(value):
        raise UsageError(f"{name}: expected {expected}, found one with masked entries")
    try:
        found = np.asarray(value)
    except (TypeError, ValueError, OverflowError):  # rows of different lengths, or objects that are not numbers
        raise UsageError(f"{name}: expected {expected}, found what is no array of numbers") from None
    if found.dtype.kind == "O" and found.ndim == 0:
        refuse_type(name, expected, value)
    if found.dtype.kind not in kinds:
        raise UsageError(f"{name}: expected {expected}, found {described(found)}")
    return found


def shaped(
    name: str, value: Any, shape: Tuple[Optional[int], ...], expected: str
) -> npt.NDArray[np.float64]:
    """Returns a float64 array of this shape, in C order. A None in `shape` permits any length."""
    found = array(name, value, expected)
    if found.ndim != len(shape) or any(want not in (None, has) for want, has in zip(shape, found.shape)):
        raise UsageError(f"{name}: expected {expected}, found {described(found)}")
    return np.ascontiguousarray(found, dtype=np.float64)


def finite(name: str, numbers: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    if not np.isfinite(numbers).all():
        raise UsageError(f"{name}: expected finite numbers, found nan or inf")
    return numbers


def matrix(name: str, value: Any) -> npt.NDArray[np.float64]:
    return finite(name, shaped(name, value, (4, 4), "a matrix of the shape (4, 4)"))


def listener(name: str, value: Any) -> Any:
    if not callable(value):
        refuse_type(name, "a function of (stage, done, total)", value)
    return value


def words(name: str, value: Any) -> str:
    """Returns the words of one or several strings, separated by commas."""
    if isinstance(value, str):
        return text(name, value)
    try:
        several = list(value)
    except TypeError:
        several = [None]
    if not all(isinstance(word, str) for word in several):
        refuse_type(name, "a word or several", value)
    return ",".join(text(name, word) for word in several)


# Types of arguments, each with its check.
Positive = Annotated[float, positive]
Distance = Annotated[float, distance]
Threads = Annotated[int, functools.partial(whole, most=4096)]
Antialias = Annotated[int, functools.partial(whole, least=1, most=64)]
Progress = Annotated[Callable[[str, int, int], object], listener]
Words = Annotated[Union[str, Iterable[str]], words]
InsetAndHeight = Annotated[Tuple[float, float], inset_and_height]
Lengths = Annotated[Union[float, Tuple[float, float]], lengths]
Coordinates = Annotated[Vector, coordinates]
Matrix = Annotated[npt.ArrayLike, matrix]
