"""The exceptions of the package: one class for each kind of failure."""


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


class DefectWarning(UserWarning):
    """A defect of a file or a mesh, because of which the result may not be as intended. With `strict`, a DefectError is
    raised instead."""

    __module__ = "lamella"
