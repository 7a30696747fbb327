#!/usr/bin/env python3
"""Draws a layered SVG file as an image: the stack of layers opened at one of them, and that layer from above.

usage: tools/draw_layers.py LAYERED.svg IMAGE.svg [HEIGHT]

HEIGHT is the height at which the stack is opened, as a part of the whole (default 0.93). The geometry is that of the
file; only every few layers are drawn, and points less than a fifth of a pixel off a straight line are left out.
"""

import math
import sys
import xml.etree.ElementTree as xml

WIDTH, HEIGHT, MARGIN = 960, 560, 40
SHEETS = 56  # layers drawn in the stack
GAP = 0.2  # height by which the stack is opened, as a part of the model's height
TILT = math.radians(24)  # of the view above the horizon
TURN = math.radians(32)  # of the model about the vertical axis
PAPER, INK, LOW, HIGH, CUT = "#fbfaf7", "#2f3437", (0x8f, 0xa3, 0xad), (0xe9, 0xee, 0xf0), "#e8762c"


def read_layers(path):
    """Returns the tops, a list of z, and the layers: each is a list of rings, each ring a list of (x, y)."""
    tops, layers = [], []
    for group in xml.parse(path).getroot().iter("{http://www.w3.org/2000/svg}g"):
        rings = []
        for shape in group.iter("{http://www.w3.org/2000/svg}polygon"):
            numbers = [float(number) for number in shape.get("points").replace(",", " ").split()]
            rings.append(list(zip(numbers[0::2], numbers[1::2])))
        if rings:
            tops.append(float(group.get("{http://slic3r.org/namespaces/slic3r}z")))
            layers.append(rings)
    return tops, layers


def path_data(rings, project):
    """Returns SVG path data of the projected rings, without points that cannot be seen."""
    parts = []
    for ring in rings:
        points = thinned([project(point) for point in ring], 0.2)
        parts.append("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + "Z")
    return "".join(parts)


def thinned(points, tolerance):
    """Simplifies a ring by Douglas and Peucker 1973, without recursion."""
    middle = max(range(len(points)), key=lambda i: math.dist(points[0], points[i]))
    ring = points + points[:1]
    keep = {0, middle}
    pending = [(0, middle), (middle, len(points))]
    while pending:
        first, last = pending.pop()
        (ax, ay), (bx, by) = ring[first], ring[last]
        length = math.hypot(bx - ax, by - ay) or 1
        worst, at = tolerance, None
        for i in range(first + 1, last):
            px, py = ring[i]
            away = abs((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / length
            if away > worst:
                worst, at = away, i
        if at is not None:
            keep.add(at)
            pending += [(first, at), (at, last)]
    return [points[i] for i in sorted(keep)]


def shade(part):
    return "#" + "".join(f"{round(low + (high - low) * part):02x}" for low, high in zip(LOW, HIGH))


def draw(tops, layers, opened_at):
    points = [point for rings in layers for ring in rings for point in ring]
    (x0, x1), (y0, y1) = ((min(c), max(c)) for c in zip(*points))
    cx, cy, wide, deep = (x0 + x1) / 2, (y0 + y1) / 2, x1 - x0, y1 - y0
    tall = tops[-1] - tops[0]
    opened = min(range(len(layers)), key=lambda i: abs(tops[i] - tops[0] - opened_at * tall))

    # The stack, seen from the side, fills the left half; the layer, seen from above, the right half.
    across = (wide * math.cos(TURN) + deep * math.sin(TURN)) / 2
    reach = (wide * math.sin(TURN) + deep * math.cos(TURN)) / 2
    scale = min((HEIGHT - 2 * MARGIN) / (tall * (1 + 2 * GAP) * math.cos(TILT) + 2 * reach * math.sin(TILT)),
                (WIDTH / 2 - 1.5 * MARGIN) / (2 * across))
    high = (tall * (1 + 2 * GAP) * math.cos(TILT) + 2 * reach * math.sin(TILT)) * scale
    base = (HEIGHT + high) / 2 - reach * math.sin(TILT) * scale

    def in_stack(height):
        def project(point):
            x, y = point[0] - cx, point[1] - cy
            right = x * math.cos(TURN) - y * math.sin(TURN)
            away = x * math.sin(TURN) + y * math.cos(TURN)
            return (WIDTH / 4 + right * scale,
                    base - (height * math.cos(TILT) + away * math.sin(TILT)) * scale)
        return project

    flat = min((WIDTH / 2 - 2 * MARGIN) / wide, (HEIGHT - 4 * MARGIN) / deep)

    def from_above(point):
        return WIDTH * 0.75 + (point[0] - cx) * flat, HEIGHT / 2 - (point[1] - cy) * flat

    step = max(1, len(layers) // SHEETS)
    shown = sorted(set(range(0, len(layers), step)) | {opened, len(layers) - 1})
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">',
           "<title>A model in layers, and one of its layers</title>",
           f'<rect width="{WIDTH}" height="{HEIGHT}" rx="12" fill="{PAPER}"/>',
           f'<g fill-rule="evenodd" stroke="{INK}" stroke-width="0.5" stroke-linejoin="round">']
    for i in shown:
        lift = tall * GAP * ((i >= opened) + (i > opened))
        fill = CUT if i == opened else shade(i / len(layers))
        out.append(f'<path fill="{fill}" d="{path_data(layers[i], in_stack(tops[i] - tops[0] + lift))}"/>')
    out.append(f'<path fill="{CUT}" stroke-width="1" d="{path_data(layers[opened], from_above)}"/>')
    out += ["</g>", "</svg>", ""]
    return "\n".join(out)


def main(arguments):
    if len(arguments) not in (3, 4):
        sys.exit(__doc__.strip())
    tops, layers = read_layers(arguments[1])
    if len(layers) < 2:
        sys.exit(f"draw_layers: {arguments[1]} has fewer than two layers with a ring in them")
    image = draw(tops, layers, float(arguments[3]) if len(arguments) == 4 else 0.93)
    with open(arguments[2], "w", encoding="utf-8") as file:
        file.write(image)


if __name__ == "__main__":
    main(sys.argv)
