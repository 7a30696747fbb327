"""Contours from the tool path of a printer (G-code) that has one wall and nothing else.

The middle of the wall is half its width w inside the material. Steiner's formula gives the area within the contour:
area + length * w/2 + pi (w/2)^2 for an outer ring, area - length * w/2 + pi (w/2)^2 for a hole. It rounds corners, so
areas are approximate. Printers run rings in either direction: a ring is a hole if it is inside an odd number of others.
"""

import math

from bench.harness.layers import Layer
from bench.rivals.ring import length, signed_area

SHORT_MM = 0.1  # less than the width of any path


def read_layers(path, starts_layer, is_wall, width, layer_height):
    """Returns the rings of each layer, from consecutive extruding moves.

    `starts_layer(line)` recognises the comment that begins a layer. `is_wall(line)` is called for every comment: True
    and False switch, None keeps. A ring may consist of several kinds of wall.
    """
    layers = []
    for number, rings in enumerate(read_rings(path, starts_layer, is_wall)):
        if rings:
            layers.append(Layer((number + 0.5) * layer_height, len(rings), enclosed_area(rings, width)))
    return layers


def read_rings(path, starts_layer, is_wall):
    """Yields the rings of each layer in turn."""
    rings = None  # of the current layer
    wall = False
    x = y = extruded = 0.0
    ring = []

    def close():
        nonlocal ring
        if ring and math.dist(ring[0], ring[-1]) < 1e-9:
            ring.pop()
        if len(ring) >= 3 and rings is not None:
            rings.append(ring)
        ring = []

    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            if line.startswith(";"):
                if starts_layer(line):
                    close()
                    if rings is not None:
                        yield rings
                    rings = []
                switched = is_wall(line)
                if switched is not None and switched != wall:
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
            # A step too short to change the rounded amount of material belongs to the path, too.
            step = math.dist((x, y), (to_x, to_y))
            if moves and wall and (amount > extruded or (ring and amount == extruded and step < SHORT_MM)):
                if not ring:
                    ring = [(x, y)]
                ring.append((to_x, to_y))
            elif moves or amount < extruded:
                close()
            x, y, extruded = to_x, to_y, amount
    close()
    if rings is not None:
        yield rings


def enclosed_area(rings, width):
    boxes = [box(ring) for ring in rings]
    area = 0.0
    for i, ring in enumerate(rings):
        x, y = ring[0]
        around = sum(j != i and low_x < x < high_x and low_y < y < high_y and contains(rings[j], x, y)
                     for j, (low_x, low_y, high_x, high_y) in enumerate(boxes))
        side = 1 if around % 2 == 0 else -1
        area += side * (abs(signed_area(ring)) + side * length(ring) * width / 2 + math.pi * width * width / 4)
    return area


def box(ring):
    xs, ys = zip(*ring)
    return min(xs), min(ys), max(xs), max(ys)


def contains(ring, x, y):
    """Counts the crossings of a ray to the right."""
    inside = False
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            inside = not inside
    return inside
