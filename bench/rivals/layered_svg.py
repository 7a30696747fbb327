"""Layers from a layered SVG file as Slic3r writes it: one <g> a layer, one <polygon> a ring."""

import re

from bench.harness.layers import Layer
from bench.rivals.ring import length, signed_area

GROUP = re.compile(r'<g\b.*\bslic3r:z="([^"]*)"')
POINTS = re.compile(r'<polygon\b.*\bpoints="([^"]*)"')


def read_layers(path):
    """Slic3r 1.3.0 multiplies the height of the cut (in millimetres) by a millionth; that is undone here."""
    layers = []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            group = GROUP.search(line)
            if group:
                layers.append(Layer(float(group[1]), 0, 0.0, 0.0))
                continue
            polygon = POINTS.search(line)
            if polygon and layers:
                ring = [tuple(map(float, pair.split(","))) for pair in polygon[1].split()]
                layers[-1].contours += 1
                layers[-1].area_mm2 += signed_area(ring)
                layers[-1].perimeter_mm += length(ring)
    if layers and layers[-1].z < 0.01:
        for layer in layers:
            layer.z *= 1e6
    return [layer for layer in layers if layer.contours]
