"""Contours from the tool path of a printer (G-code) that has one wall and nothing else.

The wall's middle runs half its width w inside the contour. For a region with the contour's turns, Steiner's formula
gives back what the contour encloses: area + length * w/2 + pi (w/2)^2 for each outer ring, and less that for a hole.
Corners are rounded by it, so areas are near, not exact.
"""

import math

from bench.harness.layers import Layer
from bench.rivals.ring import length, signed_area


def read_layers(path, starts_layer, is_wall, width, layer_height):
    """Rings of each layer, from extruding moves that follow one another.

    `starts_layer(line)` tells the comment that begins a layer; `is_wall(line)` is asked about every comment: True and
    False switch, None keeps. Holes are told from bodies by their direction: clockwise.
    """
    layers = []
    wall = False
    x = y = extruded = 0.0
    ring = []

    def close():
        nonlocal ring
        if len(ring) >= 3 and layers:
            add_ring(layers[-1], ring, width)
        ring = []

    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            if line.startswith(";"):
                if starts_layer(line):
                    close()
                    layers.append(Layer((len(layers) + 0.5) * layer_height, 0, 0.0))
                switched = is_wall(line)
                if switched is not None:
                    close()
                    wall = switched
                continue
            words = {word[0]: word[1:] for word in line.split(";", 1)[0].split()}
            if words.get("G") == "92" and "E" in words:
                extruded = float(words["E"])
            if words.get("G") not in ("0", "1"):
                continue
            amount = float(words.get("E", extruded))
            moves = "X" in words or "Y" in words
            to_x, to_y = float(words.get("X", x)), float(words.get("Y", y))
            if moves and amount > extruded and wall:
                if not ring:
                    ring = [(x, y)]
                ring.append((to_x, to_y))
            elif moves or amount < extruded:
                close()
            x, y, extruded = to_x, to_y, amount
    close()
    return [layer for layer in layers if layer.contours]


def add_ring(layer, ring, width):
    if math.dist(ring[0], ring[-1]) < 1e-9:
        ring.pop()
    area = signed_area(ring)
    turn = 1 if area > 0 else -1
    layer.contours += 1
    layer.area_mm2 += area + length(ring) * width / 2 + turn * math.pi * width * width / 4
