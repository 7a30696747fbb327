"""Converts layers to polygons of shapely, which is imported on first use, because Lamella itself does not need it, and
back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments as check

if TYPE_CHECKING:
    from ._lamella import Layer

SAME_AREA = 1e-9  # of the box around the material


def multi_polygon(layer: Layer) -> Any:
    try:
        from shapely.geometry import MultiPolygon, Polygon  # type: ignore[import]
        from shapely.ops import unary_union  # type: ignore[import]
        from shapely.validation import make_valid  # type: ignore[import]
    except ImportError as error:
        raise ImportError("to_shapely needs shapely: on Debian, apt install python3-shapely") from error
    united = layer._filled("positive")  # unites overlapping bodies
    polygons = [Polygon(united[outer], [united[hole] for hole in holes]) for outer, holes in united.polygons()]
    joined = MultiPolygon(polygons)
    # Bodies that share edges, and rings that touch themselves, are correct, but not valid in shapely.
    if not joined.is_valid:
        joined = unary_union([make_valid(polygon) for polygon in polygons])
    if abs(joined.area - united.area) > SAME_AREA * joined.envelope.area:
        joined = unary_union(_faces_with_material(united))
    return MultiPolygon([part for part in getattr(joined, "geoms", [joined]) if isinstance(part, Polygon)])


def _faces_with_material(layer: Layer) -> List[Any]:
    """Returns the faces between the edges of rings of any form, where the winding number is positive. make_valid takes
    every second one, and counts edges that run to and fro once."""
    from shapely.geometry import LineString
    from shapely.ops import polygonize, unary_union

    rings = [np.vstack([ring, ring[:1]]) for ring in list(layer)[: layer.rings]]
    faces = polygonize(unary_union([LineString(ring) for ring in rings]))
    begin, end = np.concatenate([ring[:-1] for ring in rings]), np.concatenate([ring[1:] for ring in rings])

    def winding(point: Any) -> int:
        x, y = begin - (point.x, point.y), end - (point.x, point.y)
        left = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
        up, down = (x[:, 1] <= 0) & (y[:, 1] > 0), (x[:, 1] > 0) & (y[:, 1] <= 0)
        return int((up & (left > 0)).sum() - (down & (left < 0)).sum())

    return [face for face in faces if winding(face.representative_point()) > 0]


def contours_of(name: str, geometry: Any) -> Tuple[List[npt.NDArray[Any]], List[npt.NDArray[Any]], int]:
    """Returns the rings, the open chains, and the number of points of a geometry of shapely."""
    rings: List[npt.NDArray[Any]] = []
    chains: List[npt.NDArray[Any]] = []
    points = 0
    waiting = [geometry]
    while waiting:
        part = waiting.pop()
        kind = getattr(part, "geom_type", None)
        if not isinstance(kind, str):
            check.refuse_type(name, "a geometry of shapely", part)
        if hasattr(part, "geoms"):
            waiting.extend(reversed(part.geoms))
        elif part.is_empty:
            continue
        elif kind == "Polygon":
            rings.append(_turning(part.exterior, counter_clockwise=True))
            rings.extend(_turning(hole, counter_clockwise=False) for hole in part.interiors)
        elif kind == "LineString":
            chains.append(_positions(part))
        elif kind == "LinearRing":
            rings.append(_positions(part))
        else:
            points += 1
    return rings, chains, points


def _positions(line: Any) -> npt.NDArray[Any]:
    return np.asarray(line.coords)[:, :2]  # without heights


def _turning(ring: Any, counter_clockwise: bool) -> npt.NDArray[Any]:
    points = _positions(ring)
    return points if ring.is_ccw == counter_clockwise else points[::-1]
