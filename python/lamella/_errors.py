"""The exceptions of the package: one class for each kind of failure."""

import errno
import functools
import os
import re
from typing import Iterable, Match, Tuple, Type, Union

#: What terminals and editors do not show as a character: controls, line ends of Unicode, and marks that reverse text.
_UNFIT = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
_BEGINNING, _END = 600, 600  # characters that a long text keeps


def printable(text: str) -> str:
    """Returns the text as one line without such characters: each of their bytes becomes \\xNN, as in the program."""

    def escaped(found: Match[str]) -> str:
        return "".join(f"\\x{byte:02x}" for byte in os.fsencode(found.group()))

    try:
        return _UNFIT.sub(escaped, text)
    except UnicodeError:  # surrogates that no bytes of a file name lead to
        return _UNFIT.sub("?", text)


def one_line(text: str) -> str:
    """Returns a message in printable form. Names in it may be of any length, so its middle is cut out if it is long."""
    line = printable(text)
    return line if len(line) <= _BEGINNING + _END else f"{line[:_BEGINNING]}...{line[-_END:]}"


class Error(Exception):
    """Base class of all failures that Lamella reports. Its text is one line: the file, the location in it, the content
    found, and the content expected."""

    __module__ = "lamella"

    def __init__(self, *arguments: object) -> None:
        super().__init__(*(one_line(one) if isinstance(one, str) else one for one in arguments))


class InternalError(Error):
    """A defect of Lamella itself; please report it."""

    __module__ = "lamella"


class UsageError(Error, ValueError):
    """Arguments that contradict each other or cannot be satisfied."""

    __module__ = "lamella"


class InputError(Error):
    """A file or a mesh that cannot be read or contains nothing to slice."""

    __module__ = "lamella"


class DefectError(Error):
    """A defect of a file or a mesh when `strict` is set."""

    __module__ = "lamella"


class LimitError(Error):
    """A limit was exceeded: the number of triangles, the amount of memory, or the range of numbers."""

    __module__ = "lamella"


class OutputError(Error):
    """A file that cannot be written; nothing was left at its path."""

    __module__ = "lamella"


class CancelledError(Error):
    """The work was stopped before its end."""

    __module__ = "lamella"


def error_of(kind: str, text: str, cause: int = 0, filename: Union[None, str, bytes] = None) -> Error:
    """Returns an error of the class of this name. If an error of the system (an errno) is the cause, it is also what
    Python raises for that, such as a FileNotFoundError; without memory, a MemoryError."""
    plain: Type[Error] = globals()[kind]
    if cause == 0:
        return plain(text)
    error = _also(kind, MemoryError if cause == errno.ENOMEM else type(OSError(cause, "")))(text)
    setattr(error, "errno", cause)
    setattr(error, "strerror", os.strerror(cause))
    if isinstance(error, OSError):
        error.filename = filename
    return error


def name_the_file(error: OSError, values: Iterable[object]) -> None:
    """Sets the `filename` of an error: the path among the arguments of a function that its text names."""
    for value in values:
        if error.filename is None and isinstance(value, (str, os.PathLike)):
            path = os.fspath(value)
            if os.fsdecode(path) in str(error):
                error.filename = path


@functools.lru_cache(maxsize=None)
def _also(kind: str, other: type) -> Type[Error]:
    """Returns the class with a second base. A pickled error contains what `error_of` takes, because nobody can import
    this class."""

    plain: Type[Error] = globals()[kind]

    def reduce(self: Error) -> Tuple[object, ...]:
        return error_of, (kind, str(self), getattr(self, "errno"), getattr(self, "filename", None))

    members = {"__module__": "lamella", "__doc__": plain.__doc__, "__str__": Exception.__str__, "__reduce__": reduce}
    return type(kind, (plain, other), members)


class DefectWarning(UserWarning):
    """A defect of a file or a mesh, because of which the result may not be as intended. With `strict`, a DefectError is
    raised instead."""

    __module__ = "lamella"
