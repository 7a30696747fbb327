"""Images of the parts of the paper, and of the false match in its Fig. 2."""

import json
import random
import struct
import subprocess
from dataclasses import dataclass

from bench.harness import chart, parts
from tools import draw_layers

@dataclass(frozen=True)
class View:
    figures: str  # of the paper, with the part
    opened: float  # height of the layer at which the stack is opened, as a fraction of the whole
    layers: int = 60  # number drawn; few if they are all alike or have many details


VIEWS = {"calibration": View("Fig. 11", 0.72), "dodecahedra": View("Fig. 10", 0.5), "rook": View("Fig. 6", 0.93),
         "sheet-100": View("Fig. 5a", 0.5, 2), "sheet-100-edge": View("Fig. 5b", 0.5), "sheet-225": View("Fig. 15", 0.5, 2),
         "head": View("Fig. 16", 0.62), "sole": View("Figs. 17 and 18", 0.3, 5), "sheet-484": View("Fig. 13", 0.5, 2),
         "sheet-729": View("Fig. 14", 0.5, 2), "sheet-1225": View("Fig. 12", 0.5, 2)}


def of_part(part, program, folder, parts_folder):
    """Draws a part in layers, opened at one of them, and this layer from above, as SVG text."""
    mesh = parts.make(part, program, parts_folder)
    slices = folder / "picture.svg"
    box = json.loads(run(program, "info", mesh, "--json"))["bbox"]
    height = box[1][2] - box[0][2]
    view = VIEWS[part.name]
    run(program, "slice", mesh, "-o", slices, "--layer-height", f"{height / view.layers:.4f}")
    return draw_layers.draw(*draw_layers.read_layers(slices), view.opened)


def of_false_match(program, folder):
    """Draws two boxes that touch along an edge, with an order of triangles for which the conventional engine fails."""
    triangles = box_triangles(0, 0) + box_triangles(10, 10)
    random.Random(3).shuffle(triangles)
    mesh = folder / "touching.stl"
    mesh.write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(c for corner in triangle for c in corner), 0) for triangle in triangles))
    found = {}
    for engine in ("conventional", "sweep"):
        layers = folder / "touching.json"
        run(program, "slice", mesh, "-o", layers, "--layer-height", "1", "--layers", "2:3", "--engine", engine)
        rings = json.loads(layers.read_text(encoding="utf-8"))["layers"][0]["parts"][0]["rings"]
        found[engine] = [list(zip(ring[0::2], ring[1::2])) for ring in rings]
    return drawn({"points compared (conventional)": found["conventional"], "edges compared (ECC, EECC, sweep)": found["sweep"]})


def box_triangles(x, y, side=10, height=5):
    p = [(x + side * (i & 1), y + side * (i >> 1 & 1), height * (i >> 2 & 1)) for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [triangle for a, b, c, d in faces for triangle in ((p[a], p[b], p[c]), (p[a], p[c], p[d]))]


def drawn(columns):
    """Draws rings side by side in different colours, with an arrow on every edge. Clockwise rings are holes."""
    scale, top, width = 12, 60, 320
    shapes = ['<defs><marker id="arrow" markerWidth="7" markerHeight="7" refX="5" refY="3" orient="auto">'
              '<path d="M0 0L6 3L0 6Z" fill="context-stroke"/></marker></defs>']
    for column, (title, rings) in enumerate(columns.items()):
        left = 20 + width * column
        many = f"{len(rings)} rings" if len(rings) != 1 else "1 ring"
        shapes.append(chart.text(left, 22, title, weight="bold"))
        shapes.append(chart.text(left, 42, f"{many}, {abs(sum(map(area, rings))):g} mm² of 200"))
        for i, ring in enumerate(rings):
            at = [(left + scale * x, top + scale * (20 - y)) for x, y in ring]
            for (ax, ay), (bx, by) in zip(at, at[1:] + at[:1]):
                shapes.append(f'<line x1="{ax:.1f}" y1="{ay:.1f}" x2="{bx:.1f}" y2="{by:.1f}" stroke="{chart.colour(2 * i)}" '
                              'stroke-width="2.5" marker-end="url(#arrow)"/>')
    return chart.svg(2 * width, top + scale * 20 + 20, "A false match", shapes)


def area(ring):
    return sum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1])) / 2


def run(program, *words):
    return subprocess.run([str(program), *map(str, words)], check=True, capture_output=True, text=True).stdout
