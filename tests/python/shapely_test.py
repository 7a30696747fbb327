"""Layers as shapely's polygons: the same areas, holes where they belong."""

import numpy as np
import pytest
from conftest import nested_boxes, open_box
from shapely.geometry import GeometryCollection, LinearRing, LineString, MultiPolygon, Point, Polygon
from shapely.ops import unary_union

import lamella


def test_holes_and_nesting_are_right():
    layer = lamella.slice(nested_boxes(), 1)[5]
    material = layer.to_shapely()
    assert isinstance(material, MultiPolygon) and material.is_valid
    assert sorted((polygon.area, len(polygon.interiors)) for polygon in material.geoms) == [(16, 0), (36, 1)]


@pytest.mark.parametrize("body", [("rook",), ("calibration",), ("dodecahedra",), ("sheet", "--holes", 25)])
def test_areas_and_lengths_are_those_of_the_layers(bodies, body):
    for layer in lamella.slice(bodies(*body), 1):
        material = layer.to_shapely()
        assert np.isclose(material.area, layer.area, rtol=1e-12)
        assert np.isclose(material.length, layer.perimeter, rtol=1e-12)
        assert sum(1 + len(polygon.interiors) for polygon in material.geoms) == layer.rings


def test_material_of_bodies_that_overlap_counts_once():
    square = np.array([(0, 0), (4, 0), (4, 4), (0, 4)])
    layer = lamella.Layer([square, square + (2, 2), square + (8, 0), (square / 2 + (9, 1)), (square / 2 + (20, 0))[::-1]], z=1)
    material = layer.to_shapely()
    assert material.is_valid
    assert np.isclose(material.area, 16 + 12 + 16)


def test_polygons_are_valid_wherever_rings_overlap_or_touch():
    numbers = np.random.default_rng(7)
    for _ in range(300):
        rings = list(random_rings(numbers))
        material = lamella.Layer(rings, z=1).to_shapely()
        expected = unary_union([Polygon(ring) for ring in rings])
        assert material.is_valid
        assert np.isclose(material.area, expected.area, rtol=0, atol=1e-6)


def odd_rings(numbers):
    """Rings that touch, cross and repeat themselves, are flat, or are tiny."""
    for _ in range(numbers.integers(1, 8)):
        count = numbers.integers(3, 12)
        grid = numbers.integers(0, 6, (count, 2)).astype(float)
        yield (
            grid,
            grid[::-1] % 3,
            numbers.random((count, 2)) * 10,
            np.column_stack([np.linspace(0, 9, count), np.zeros(count)]),
            np.repeat(grid, 2, axis=0),
            np.concatenate([grid, grid[::-1]]),
            grid * 1e-9 + grid[0],
            numbers.random((count, 2)) * (10, 1e-13),
        )[numbers.integers(8)]


def test_polygons_are_valid_for_any_layer():
    numbers = np.random.default_rng(11)
    for _ in range(2000):
        scale = 10.0 ** numbers.integers(-6, 7) if numbers.integers(2) else 1
        layer = lamella.Layer([ring * scale for ring in odd_rings(numbers)], z=1)
        material = layer.to_shapely()
        assert isinstance(material, MultiPolygon) and material.is_valid
        assert np.isclose(material.area, layer.filled("positive").area, rtol=1e-6, atol=1e-6 * (10 * scale) ** 2)


def test_layers_are_made_of_geometries():
    hollow = Polygon([(0, 0), (0, 9), (9, 9), (9, 0)], [[(1, 1), (2, 1), (2, 2)]])
    layer = lamella.Layer.from_shapely(hollow, 1, bottom=0.5, top=2)
    assert (layer.z, layer.bottom, layer.top, layer.rings) == (1, 0.5, 2, 2)
    assert layer.parent.tolist() == [-1, 0] and np.isclose(layer.area, hollow.area)
    assert layer.to_shapely().equals(hollow)
    lines = GeometryCollection([hollow, LineString([(0, 0, 5), (1, 1, 5)]), LinearRing([(20, 0), (21, 0), (21, 1)])])
    layer = lamella.Layer.from_shapely(lines, 1)
    assert (layer.rings, layer.open_chains) == (3, 1)
    with pytest.warns(lamella.DefectWarning, match="^2 points left out"):
        assert len(lamella.Layer.from_shapely(GeometryCollection([Point(1, 2), Point(2, 3)]), 1)) == 0
    assert len(lamella.Layer.from_shapely(MultiPolygon(), 1)) == 0


def test_layers_come_back_from_geometries():
    numbers = np.random.default_rng(3)
    for _ in range(100):
        layer = lamella.Layer(list(random_rings(numbers)), z=1)
        material = layer.to_shapely()
        again = lamella.Layer.from_shapely(material, 1)
        assert np.isclose(again.area, layer.filled("positive").area) and again.to_shapely().equals(material)


def test_layers_without_material_are_empty():
    assert lamella.Layer([], z=0).to_shapely().is_empty
    with pytest.warns(lamella.DefectWarning):
        assert lamella.slice(open_box(), 1)[0].to_shapely().is_empty


def random_rings(numbers):
    """Stars and boxes that may overlap; boxes share corners and edges."""
    for _ in range(numbers.integers(1, 9)):
        if numbers.integers(2):
            turns = np.linspace(0, 2 * np.pi, numbers.integers(3, 30), endpoint=False)
            radii = numbers.uniform(0.3, 1, len(turns)) * numbers.uniform(1, 5)
            yield np.column_stack([np.cos(turns), np.sin(turns)]) * radii[:, None] + numbers.uniform(0, 10, 2)
        else:
            yield numbers.integers(0, 10, 2) + np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * numbers.integers(1, 6, 2)


def test_layers_are_combined_as_shapely_combines_polygons():
    numbers = np.random.default_rng(5)
    for _ in range(300):
        rings, other_rings = list(random_rings(numbers)), list(random_rings(numbers))
        layer, other = lamella.Layer(rings, z=1), lamella.Layer(other_rings, z=2)
        shape, other_shape = (unary_union([Polygon(ring) for ring in each]) for each in (rings, other_rings))
        for name in ("union", "intersection", "difference", "symmetric_difference"):
            found = getattr(layer, name)(other)
            expected = getattr(shape, name)(other_shape)
            assert np.isclose(found.area, expected.area, rtol=0, atol=1e-6)
