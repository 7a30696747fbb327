"""Reads layered SVG files as written by Slic3r: one <g> for each layer, one <polygon> for each ring."""

import re

from bench.harness.layers import Layer
from bench.rivals.ring import length, signed_area

GROUP = re.compile(r'<g\b.*\bslic3r:z="([^"]*)"')
POINTS = re.compile(r'<polygon\b.*\bpoints="([^"]*)"')


def read_layers(path):
    return [Layer(z, len(rings), sum(map(signed_area, rings)), sum(map(length, rings)))
            for z, rings in read_rings(path) if rings]


def read_rings(path):
    """Returns the height and the rings of each layer. Slic3r 1.3.0 multiplies the height of the cut (in millimetres) by
    1e-6; this is reverted here."""
    layers = []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            group = GROUP.search(line)
            if group:
                layers.append((float(group[1]), []))
                continue
            polygon = POINTS.search(line)
            if polygon and layers:
                layers[-1][1].append([tuple(map(float, pair.split(","))) for pair in polygon[1].split()])
    if layers and layers[-1][0] < 0.01:
        layers = [(z * 1e6, rings) for z, rings in layers]
    return layers
