"""The exceptions of the package: one class for each kind of failure."""

import errno
import functools
import os
from typing import Tuple, Type


class Error(Exception):
    """Base class of all failures that Lamella reports. Its text is one line: the file, the location in it, the content
    found, and the content expected."""

    __module__ = "lamella"


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


def error_of(kind: str, text: str, cause: int = 0) -> Error:
    """Returns an error of the class of this name. If an error of the system (an errno) is the cause, it is also what
    Python raises for that, such as a FileNotFoundError; without memory, a MemoryError."""
    plain: Type[Error] = globals()[kind]
    if cause == 0:
        return plain(text)
    error = _also(kind, MemoryError if cause == errno.ENOMEM else type(OSError(cause, "")))(text)
    setattr(error, "errno", cause)
    setattr(error, "strerror", os.strerror(cause))
    return error


@functools.lru_cache(maxsize=None)
def _also(kind: str, other: type) -> Type[Error]:
    """Returns the class with a second base. A pickled error contains what `error_of` takes, because nobody can import
    this class."""

    plain: Type[Error] = globals()[kind]

    def reduce(self: Error) -> Tuple[object, ...]:
        return error_of, (kind, str(self), getattr(self, "errno"))

    members = {"__module__": "lamella", "__doc__": plain.__doc__, "__str__": Exception.__str__, "__reduce__": reduce}
    return type(kind, (plain, other), members)


class DefectWarning(UserWarning):
    """A defect of a file or a mesh, because of which the result may not be as intended. With `strict`, a DefectError is
    raised instead."""

    __module__ = "lamella"
