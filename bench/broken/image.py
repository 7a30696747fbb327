"""Draws one layer of each slicer as an SVG of panels side by side."""

from bench.harness import chart

PANEL, GAP, HEAD = 180, 16, 40
MATERIAL, WALL, OPEN = "#cfe8dc", "#0b6e4f", "#d1495b"


def image(title, panels, bounds):
    """Draws the panels [(title, Drawing or None, note)]; `bounds` are those of the mesh."""
    (low_x, low_y, _), (high_x, high_y, _) = bounds
    margin = 0.08 * max(high_x - low_x, high_y - low_y)
    scale = PANEL / (max(high_x - low_x, high_y - low_y) + 2 * margin)
    tall = scale * (high_y - low_y + 2 * margin)

    def place(left):
        return lambda point: (left + scale * (point[0] - low_x + margin), HEAD + scale * (high_y + margin - point[1]))

    parts = [chart.text(0, 14, title, weight="bold")]
    for i, (name, drawing, note) in enumerate(panels):
        left = i * (PANEL + GAP)
        parts.append(chart.text(left, 32, name, size=12))
        parts.append(f'<rect x="{left}" y="{HEAD}" width="{PANEL}" height="{tall:.1f}" fill="none" stroke="#ddd"/>')
        if drawing is not None:
            parts += draw(drawing, place(left), scale)
        parts.append(chart.text(left, HEAD + tall + 16, note, size=12))
    return chart.svg(len(panels) * (PANEL + GAP) - GAP, round(HEAD + tall + 24), title, parts)


def draw(drawing, place, scale):
    """Fills contours by their winding numbers; draws a tool path with its width."""
    parts = []
    if drawing.rings:
        outline = " ".join(path(ring, place) + "Z" for ring in drawing.rings)
        paint = (f'fill="none" stroke="{MATERIAL}" stroke-width="{scale * drawing.width:.1f}"/><path d="{outline}" fill="none"'
                 if drawing.width else f'fill="{MATERIAL}" fill-rule="nonzero"')
        parts.append(f'<path d="{outline}" {paint} stroke="{WALL}"/>')
    for chain in drawing.chains:
        parts.append(f'<path d="{path(chain, place)}" fill="none" stroke="{OPEN}" stroke-width="2"/>')
        for x, y in (place(chain[0]), place(chain[-1])):
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{OPEN}"/>')
    return parts


def path(points, place):
    """Omits points that coincide at the scale of the image."""
    texts = []
    for point in points:
        text = "{:.1f} {:.1f}".format(*place(point))
        if not texts or text != texts[-1]:
            texts.append(text)
    return "M" + "L".join(texts)
