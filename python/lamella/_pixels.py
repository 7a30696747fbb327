"""Arrays of pixels and voxels with their position in space. The methods of the extension's classes use this module, so it does
without the extension."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Annotated, Any, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments as check
from ._errors import UsageError

MOST_LAYERS = 2**31 - 2
AS_THE_AXES = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

Three = Tuple[float, float, float]


@dataclass(frozen=True, eq=False, repr=False)
class Voxels:
    """An array of pixels of layers, or of voxels of meshes, with its position in space, in the words of ITK. The centre of
    `array[k, j, i]` is the point origin + direction · (i spacing[0], j spacing[1], k spacing[2]). NumPy takes it in place of
    the array."""

    array: npt.NDArray[Any]  #: (layers, rows, columns)
    origin: Three  #: x, y and z of the centre of `array[0, 0, 0]`, in millimetres
    _spacing: Tuple[float, float, Optional[float]]  # None for layers without a common distance
    #: The directions of columns, rows and layers, which are the columns of a 3x3 matrix: its numbers, row by row.
    direction: Tuple[float, ...] = AS_THE_AXES
    labels: Tuple[str, ...] = ()  #: of the parts with the numbers 1, 2, ..., if the array has numbers of parts

    @property
    def spacing(self) -> Three:
        """Returns the distance of neighbours along columns, rows and layers, in millimetres. Raises UsageError for a stack
        whose layers have no common distance."""
        x, y, z = self._spacing
        if z is None:
            raise UsageError(
                "spacing: the layers of this stack have no common distance; slice the part with layers of one height, or take "
                "the height of each layer from the stack"
            )
        return x, y, z

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> npt.NDArray[Any]:
        if copy:
            return np.array(self.array, dtype=dtype)
        found = np.asarray(self.array, dtype=dtype)
        if copy is False and found is not self.array:
            raise ValueError("an array of another type is a copy")
        return found

    def __repr__(self) -> str:
        return f"<lamella.Voxels: {' x '.join(map(str, self.array.shape))} of {self.array.dtype}>"


def _pixel_type(name: str, value: Any) -> Any:
    expected = "bool or numpy.uint8"
    try:
        found = None if value is None else np.dtype(value)
    except Exception:  # of many kinds, by what is given
        found = None
    if found is None:
        check.refuse_type(name, expected, value)
    if found not in (np.dtype(bool), np.dtype(np.uint8)):
        raise UsageError(f"{name}: {check.excerpt(found)} is not possible; expected {expected}")
    return found


def _direction(name: str, value: Any) -> Tuple[float, ...]:
    """Returns the numbers of the matrix, row by row."""
    expected = "nine numbers, or an array of the shape (3, 3)"
    found = check.array(name, value, expected)
    if found.shape not in ((9,), (3, 3)):
        raise UsageError(f"{name}: expected {expected}, found {check.described(found)}")
    matrix = check.finite(name, found.reshape(3, 3).astype(np.float64))
    # Files round directions to single precision, and some to fewer digits.
    if not (np.abs(matrix) < 2).all() or not (np.abs(matrix.T @ matrix - np.eye(3)) < 1e-4).all():
        raise UsageError(f"{name}: expected a matrix whose columns have the length 1 and are perpendicular to each other")
    return tuple(map(float, matrix.flat))


def _counts(dimensions: int, expected: str) -> check.Check:
    each = functools.partial(check.whole, least=1, most=MOST_LAYERS)
    return lambda name, value: check.several(name, value, dimensions, expected, each)


def _centre(name: str, value: Any) -> Tuple[float, float]:
    return check.pair(name, value, "two numbers (x, y)", check.number)


def three_lengths(name: str, value: Any) -> Tuple[float, ...]:
    """Returns lengths along x, y and z. One length counts for all."""
    if check.is_number(value):
        return (check.positive(name, value),) * 3
    return check.several(name, value, 3, "one length, or three (x, y, z)", check.positive)


# Types of arguments, each with its check.
PixelType = Annotated[npt.DTypeLike, _pixel_type]
Centre = Annotated[Union[Tuple[float, float], npt.NDArray[Any]], _centre]
RowsAndColumns = Annotated[Tuple[int, int], _counts(2, "two whole numbers (rows, columns)")]
Shape = Annotated[Tuple[int, ...], _counts(3, "three whole numbers (layers, rows, columns)")]
Spacing = Annotated[Union[float, Sequence[float], npt.NDArray[Any]], three_lengths]
Direction = Annotated[npt.ArrayLike, _direction]


def cells_of(
    name: str, bounds: npt.NDArray[np.float64], sizes: Sequence[float], origin: Any, shape: Any
) -> Tuple[Tuple[float, ...], Tuple[int, ...]]:
    """Returns the centre of the first of the cells, which have these sizes along x, y (and z), and the numbers of cells in
    reverse order, as arrays have them. The default is the cells that contain the bounds. `name` is that of the sizes."""
    size = np.array(sizes)
    first = bounds[0] + size / 2 if origin is None else np.array(origin)
    if shape is not None:
        count = np.array(shape[::-1], dtype=np.float64)
    else:
        with np.errstate(over="ignore"):
            count = np.maximum(1, np.ceil((bounds[1] - first + size / 2) / size * (1 - 1e-12)))  # quotients are rounded
    if not (count[:2] <= check.MOST_PIXELS).all() or not (count[2:] <= MOST_LAYERS).all():
        raise UsageError(
            f"{name if shape is None else 'shape'}: {' x '.join(f'{n:.9g}' for n in count)} "
            f"along x, y{' and z' * (len(count) > 2)} are too many; there may be {check.MOST_PIXELS} rows and columns"
        )
    return tuple(map(float, first)), tuple(int(n) for n in count[::-1])


def distance_of(heights: npt.NDArray[np.float64], thickness: npt.NDArray[np.float64]) -> Optional[float]:
    """Returns the common distance of the layers whose middles are at these heights; None if there is none."""
    if len(heights) < 2:
        return float(thickness[0]) if len(heights) and thickness[0] > 0 else None
    mean = (heights[-1] - heights[0]) / (len(heights) - 1)
    largest = max(abs(heights[0]), abs(heights[-1]))
    rounding = 1e-6 * mean + 4 * math.ulp(largest)
    return float(mean) if (np.abs(np.diff(heights) - mean) <= rounding).all() else None
