"""A hatch fill: parallel lines across the material, turned by 67 degrees from layer to layer.

usage: hatch.py MESH LAYER_HEIGHT_MM SPACING_MM
"""

import sys

import numpy as np
from shapely.affinity import rotate
from shapely.geometry import MultiLineString

import lamella


def hatched(material, angle, spacing):
    """Lines of a direction that lie in the material, as (x, y) pairs of ends."""
    level = rotate(material, -angle, origin=(0, 0))
    left, low, right, high = level.bounds
    lines = [((left, y), (right, y)) for y in np.arange(low + spacing / 2, high, spacing)]
    return rotate(level.intersection(MultiLineString(lines)), angle, origin=(0, 0))


def main(mesh, layer_height, spacing):
    length = area = 0.0
    for layer in lamella.iter_layers(mesh, float(layer_height)):
        material = layer.offset(-float(spacing) / 2).to_shapely()
        if not material.is_empty:
            length += hatched(material, 67 * layer.index, float(spacing)).length
            area += material.area
    print(f"{length:.3f} mm of hatches in {area:.3f} mm2 of layers: one mm for each {area / length:.3f} mm2")


if __name__ == "__main__":
    main(*sys.argv[1:])
