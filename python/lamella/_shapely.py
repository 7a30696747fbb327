"""Converts layers to polygons of shapely, which is imported on first use, because Lamella itself does not need it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._lamella import Layer


def multi_polygon(layer: Layer) -> Any:
    try:
        from shapely.geometry import MultiPolygon, Polygon  # type: ignore[import]
        from shapely.ops import unary_union  # type: ignore[import]
        from shapely.validation import make_valid  # type: ignore[import]
    except ImportError as error:
        raise ImportError("to_shapely needs shapely: on Debian, apt install python3-shapely") from error
    united = layer._filled("positive")  # unites overlapping bodies
    material = MultiPolygon([
        Polygon(united[outer], [united[hole] for hole in holes]) for outer, holes in united.polygons()
    ])  # fmt: skip
    if material.is_valid:
        return material
    # Bodies that share edges, and rings that touch themselves, are correct, but not valid in shapely.
    joined = unary_union([make_valid(polygon) for polygon in material.geoms])
    return MultiPolygon([part for part in getattr(joined, "geoms", [joined]) if isinstance(part, Polygon)])
