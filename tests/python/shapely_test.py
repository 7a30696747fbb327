"""Layers as shapely's polygons: the same areas, holes where they belong."""

import numpy as np
import pytest
from conftest import nested_boxes, open_box
from shapely.geometry import MultiPolygon, Polygon
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
