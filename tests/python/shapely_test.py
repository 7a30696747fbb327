"""Layers as shapely's polygons: the same areas, holes where they belong."""

import numpy as np
import pytest
from conftest import nested_boxes, open_box
from shapely.geometry import MultiPolygon

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


def test_layers_without_material_are_empty():
    assert lamella.Layer([], z=0).to_shapely().is_empty
    with pytest.warns(lamella.DefectWarning):
        assert lamella.slice(open_box(), 1)[0].to_shapely().is_empty
