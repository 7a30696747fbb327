"""The exceptions of the package: one class for each kind of failure."""


class Error(Exception):
    """Every failure that Lamella reports. Its text is one line: the file, the place in it, what was found, and what
    was expected."""

    __module__ = "lamella"


class InternalError(Error):
    """A broken promise of Lamella itself; please report it."""

    __module__ = "lamella"


class UsageError(Error, ValueError):
    """Arguments that contradict themselves or cannot be met."""

    __module__ = "lamella"


class InputError(Error):
    """A file or a mesh that cannot be read or holds nothing to slice."""

    __module__ = "lamella"


class DefectError(Error):
    """A defect of a file or a mesh, where `strict` allowed none."""

    __module__ = "lamella"


class LimitError(Error):
    """A limit was hit: of triangles, of memory, of numbers."""

    __module__ = "lamella"


class OutputError(Error):
    """A file that cannot be written; nothing was left at its path."""

    __module__ = "lamella"


class CancelledError(Error):
    """The work was stopped before its end."""

    __module__ = "lamella"


class DefectWarning(UserWarning):
    """Something was odd about a file or a mesh, and the result may not be what was meant. With `strict` it is a
    DefectError instead."""

    __module__ = "lamella"
