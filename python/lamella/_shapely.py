"""Layers as polygons of shapely. Imported when somebody asks for them: Lamella itself does not need it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._lamella import Layer


def multi_polygon(layer: Layer) -> Any:
    try:
        from shapely.geometry import MultiPolygon, Polygon  # type: ignore[import]
    except ImportError as error:
        raise ImportError("to_shapely needs shapely: on Debian, apt install python3-shapely") from error
    return MultiPolygon([
        Polygon(layer[outer], [layer[hole] for hole in holes]) for outer, holes in layer.polygons()
    ])  # fmt: skip
