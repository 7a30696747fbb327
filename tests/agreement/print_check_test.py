"""Islands, cavities and overhangs of `lamella check` against bodies whose answers are known, and against a search that shares
no code with it.

Bodies are prisms and frusta. A layer is cut at its middle, so that its areas follow from their corners. The search fills rows:
it cuts layers along lines of constant y, connects runs of material or of space that overlap in the next row or in the layer
above, and follows the connected areas from layer to layer. Between two rows a body of boxes does not change; rows at all
their edges are therefore exact. Rows across other meshes are pixels with exact ends: what is thinner than a row may be lost.

Needs LAMELLA_PROGRAM, and LAMELLA_SHARED for the public meshes.
"""

import json
import math
import os
import random
import sys
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("no NumPy: skipped")
    sys.exit(0)

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, binary_stl, main  # noqa: E402

MESHES = Path(os.environ.get("LAMELLA_SHARED", "")) / "meshes"
# The program counts material as carried up to 1.002 of the distance that the angle allows, so that a wall at just this angle is
# not an overhang on account of rounding.
SLACK = 1.002


# Bodies: vertices and triangles that face outwards, or inwards for space within other bodies.

def prism(ring, low, high, top=None, space=False):
    """Between a ring at one height and one with as many corners at another. Its horizontal faces are fans, which overlap
    themselves if the ring is not convex; no layer is cut there."""
    n = len(ring)
    vertices = [(x, y, low) for x, y in ring] + [(x, y, high) for x, y in top or ring]
    faces = [face for i in range(1, n - 1) for face in ((0, i + 1, i), (n, n + i, n + i + 1))]
    faces += [face for i in range(n) for k in [(i + 1) % n] for face in ((i, k, n + k), (i, n + k, n + i))]
    return vertices, [(a, c, b) for a, b, c in faces] if space else faces


def rectangle(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def polygon(x, y, radius, corners):
    turn = 2 * math.pi / corners
    return [(x + radius * math.cos((k + 0.3) * turn), y + radius * math.sin((k + 0.3) * turn)) for k in range(corners)]


def polygon_area(radius, corners):
    return corners / 2 * radius ** 2 * math.sin(2 * math.pi / corners)


def solid(x0, y0, z0, x1, y1, z1):
    return prism(rectangle(x0, y0, x1, y1), z0, z1)


def space(x0, y0, z0, x1, y1, z1):
    return prism(rectangle(x0, y0, x1, y1), z0, z1, space=True)


def tube(x0, y0, z0, x1, y1, z1, wall=1):
    return [solid(x0, y0, z0, x1, y1, z1), space(x0 + wall, y0 + wall, z0, x1 - wall, y1 - wall, z1)]


def pyramid(x, y, low, high, half_low, half_high):
    """A frustum of squares."""
    return prism(rectangle(x - half_low, y - half_low, x + half_low, y + half_low), low, high,
                 rectangle(x - half_high, y - half_high, x + half_high, y + half_high))


def moved(bodies, place):
    return [([(*place(x, y), z) for x, y, z in vertices], faces) for vertices, faces in bodies]


def turned(degrees, dx=0.0, dy=0.0):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return lambda x, y: (x * c - y * s + dx, x * s + y * c + dy)


def obj(bodies):
    """A text with all digits of the coordinates."""
    lines, first = [], 1
    for vertices, faces in bodies:
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
        lines += [f"f {a + first} {b + first} {c + first}" for a, b, c in faces]
        first += len(vertices)
    return "\n".join(lines) + "\n"


def stl(bodies):
    return binary_stl([tuple(vertices[k] for k in face) for vertices, faces in bodies for face in faces])


# The search

def counted(low, high):
    """For each range low[i]..high[i]: i and the numbers of the range, one pair after the other."""
    n = np.maximum(high - low, 0)
    offsets = np.arange(int(n.sum())) - np.repeat(np.cumsum(n) - n, n)
    return np.repeat(np.arange(len(low)), n), np.repeat(low, n) + offsets


def components(n, u, v):
    """For each of n nodes the smallest node that the edges (u, v) connect with it."""
    parent = np.arange(n)
    while True:
        a, b = parent[u], parent[v]
        apart = a != b
        if not apart.any():
            return parent
        u, v, a, b = u[apart], v[apart], a[apart], b[apart]
        np.minimum.at(parent, np.maximum(a, b), np.minimum(a, b))
        while not np.array_equal(parent[parent], parent):
            parent = parent[parent]


def runs_of_material(layers, edges, ys, eps):
    """Row (layer * rows + row), start and end of each run in which the winding number is above 0. Runs and gaps of at most eps
    do not count: they are where walls of bodies coincide."""
    low, high = (np.searchsorted(ys, bound(edges[:, 1], edges[:, 3])) for bound in (np.minimum, np.maximum))
    edge, row = counted(low, high)
    x0, y0, x1, y1 = edges[edge].T
    x = x0 + (x1 - x0) * ((ys[row] - y0) / (y1 - y0))
    key, step = layers[edge] * len(ys) + row, np.where(y1 > y0, -1, 1)
    order = np.lexsort((-step, x, key))
    key, x = key[order], x[order]
    inside = np.cumsum(step[order]) > 0
    before = np.concatenate(([False], inside[:-1]))
    first, last = np.flatnonzero(inside & ~before), np.flatnonzero(~inside & before)
    key, start, end = key[first], x[first], x[last]
    wide = end - start > eps
    key, start, end = key[wide], start[wide], end[wide]
    glued = (key[1:] == key[:-1]) & (start[1:] - end[:-1] <= eps)
    head, tail = np.concatenate(([True], ~glued)), np.concatenate((~glued, [True]))
    return key[head], start[head], end[tail]


def runs_of_space(key, start, end, rows, low, high):
    """What is between runs of material, from low to high in each row."""
    keys = np.concatenate((key, np.arange(rows)))
    starts, ends = np.concatenate((end, np.full(rows, low))), np.concatenate((start, np.full(rows, high)))
    by_start, by_end = np.lexsort((starts, keys)), np.lexsort((ends, keys))
    return keys[by_start], starts[by_start], ends[by_end]


def overlapping(one, other, shift, points):
    """Pairs of runs of which the second is `shift` rows farther and overlaps the first, or touches it if points count."""
    xs = np.unique(np.concatenate((*one[1:], *other[1:])))
    width = len(xs) + 1  # whole numbers instead of coordinates, so that nothing is rounded

    def at(key, x):
        return key * width + np.searchsorted(xs, x)
    return counted(np.searchsorted(at(other[0], other[2]), at(one[0] + shift, one[1]), "left" if points else "right"),
                   np.searchsorted(at(other[0], other[1]), at(one[0] + shift, one[2]), "right" if points else "left"))


class Cells:
    """The connected areas of all layers. Space is connected where it meets in a point, as material is not: two walls that meet
    in a point do not keep in what is behind them."""

    def __init__(self, runs, ys, heights, eps, points):
        key, start, end = runs
        layer, row = np.divmod(key, len(ys))
        u, v = overlapping(runs, runs, 1, points)
        same = layer[u] == layer[v]
        roots, label = np.unique(components(len(key), u[same], v[same]), return_inverse=True)
        self.runs, self.label, self.layer, self.count = runs, label, layer[roots], len(roots)
        area = (end - start) * heights[row]
        self.area = np.bincount(label, area, self.count)
        self.x = np.bincount(label, area * (start + end) / 2, self.count) / self.area
        self.y = np.bincount(label, area * ys[row], self.count) / self.area
        u, v = overlapping(runs, runs, len(ys), False)
        shared = np.minimum(end[u], end[v]) - np.maximum(start[u], start[v])
        u, v, area = u[shared > eps], v[shared > eps], (shared * heights[row[u]])[shared > eps]
        codes, inverse = np.unique(label[v].astype(np.int64) * self.count + label[u], return_inverse=True)
        self.below = [[] for _ in range(self.count)]
        for code, shared in zip(codes.tolist(), np.bincount(inverse, area, len(codes)).tolist()):
            self.below[code // self.count].append((code % self.count, shared))


class Region:
    def __init__(self, layer, x, y, area):
        self.layer, self.top, self.x, self.y, self.area = layer, layer, x, y, area
        self.volume, self.largest, self.ended, self.on_plate = 0.0, 0.0, False, False
        # Regions that began in the same layer and met: either of them may be the one that goes on.
        self.equals = {self}


def follow(cells, thickness, first, touch=0.0, outside=None):
    """The regions of cells that are not connected downwards with the plate or, if `outside` has the cells of space outside, with
    these. `ended` is true for islands that join and for cavities that open."""
    is_space = outside is not None
    by_layer = [[] for _ in thickness]
    for cell, layer in enumerate(cells.layer.tolist()):
        by_layer[layer].append(cell)
    regions, region_of, free = [], {}, None
    for layer in range(first, len(thickness)):
        # Groups of what this layer connects: its cells, regions, and `free`, the material on the plate or the space outside.
        parent = {free: free}

        def root(node, parent=parent):
            parent.setdefault(node, node)
            while parent[node] != node:
                node = parent[node]
            return node

        for cell in by_layer[layer]:
            parent[root(cell)] = root(cell)
            if (is_space and cell in outside) or (not is_space and layer == first):
                parent[root(cell)] = root(free)
            if layer > first and sum(shared for _, shared in cells.below[cell]) > touch:
                for other, _ in cells.below[cell]:
                    parent[root(cell)] = root(region_of[other])
        groups = {}
        for node in list(parent):
            groups.setdefault(root(node), []).append(node)
        for group in groups.values():
            old, new = [n for n in group if isinstance(n, Region)], [n for n in group if isinstance(n, int)]
            if free in group:
                for region in old:
                    region.ended = True
                region_of.update((cell, free) for cell in new)
                continue
            if not old:
                old = [Region(layer, *(float(values[new[0]]) for values in (cells.x, cells.y, cells.area)))]
                old[0].on_plate = layer == first
                regions += old
            kept = min(old, key=lambda region: region.layer)
            for other in old:
                if other is not kept:
                    if other.layer == kept.layer:
                        other.equals |= kept.equals
                        for region in other.equals:
                            region.equals = other.equals
                    if is_space:
                        kept.volume += other.volume
                        kept.largest = max(kept.largest, other.largest)
                        regions.remove(other)
                    other.ended = True
            region_of.update((cell, kept) for cell in new)
            if new:
                area = float(cells.area[new].sum())
                kept.volume += area * thickness[layer]
                kept.largest = max(kept.largest, area)
                kept.top = layer
                kept.ended = is_space and layer == len(thickness) - 1
    return regions


class Search:
    """Islands and cavities of layers given as edges, each with the index of its layer, by rows at ys."""

    def __init__(self, layers, edges, thickness, ys, heights, touch=0.0, eps=0.0):
        material = runs_of_material(layers, edges, ys, eps)
        low, high = edges[:, [0, 2]].min() - 1, edges[:, [0, 2]].max() + 1
        self.material = Cells(material, ys, heights, eps, points=False)
        spaces = Cells(runs_of_space(*material, len(thickness) * len(ys), low, high), ys, heights, eps, points=True)
        outside = set(spaces.label[spaces.runs[1] == low].tolist())
        first = int(self.material.layer.min())
        self.islands = follow(self.material, thickness, first, touch)
        self.cavities = follow(spaces, thickness, first, 0.0, outside)


def edges_of_boxes(boxes):
    """Layers of 1 mm of boxes (x0, y0, z0, x1, y1, z1, sign) that begin at z = 0 and end at whole heights."""
    layers, edges = [], []
    for x0, y0, z0, x1, y1, z1, sign in boxes:
        ring = rectangle(x0, y0, x1, y1)[::sign]
        for layer in range(z0, z1):
            edges += [(*ring[k - 1], *ring[k]) for k in range(4)]
            layers += [layer] * 4
    return np.array(layers), np.array(edges, float)


def search_boxes(boxes, touch=0.0):
    layers, edges = edges_of_boxes(boxes)
    bounds = np.unique(edges[:, 1])
    bounds = np.concatenate(([bounds[0] - 1], bounds, [bounds[-1] + 1]))
    thickness = [1.0] * max(box[5] for box in boxes)
    return Search(layers, edges, thickness, (bounds[1:] + bounds[:-1]) / 2, np.diff(bounds), touch)


def areas_of_boxes(boxes, search, distance, touch):
    """Of each layer: area, area without material below, area farther than the distance from the material below. Mitred corners
    make the material that is grown by a distance the union of its rectangles grown by it."""
    xs, ys = (np.unique([v for box in boxes for v in (box[k], box[k + 3])]) for k in (0, 1))
    number = np.zeros((max(box[5] for box in boxes), len(xs) - 1, len(ys) - 1), int)
    for x0, y0, z0, x1, y1, z1, sign in boxes:
        number[z0:z1, np.searchsorted(xs, x0):np.searchsorted(xs, x1), np.searchsorted(ys, y0):np.searchsorted(ys, y1)] += sign
    material = number > 0
    cells, islands = search.material, np.zeros_like(material)
    for key, start, end, cell in zip(*cells.runs, cells.label):
        if sum(shared for _, shared in cells.below[cell]) <= touch:
            layer, row = divmod(key, len(ys) + 1)
            islands[layer, np.searchsorted(xs, start):np.searchsorted(xs, end), row - 1] = True
    fine = [np.unique(np.clip(np.concatenate((v, v - distance, v + distance)), v[0], v[-1])) for v in (xs, ys)]
    middles = [(v[1:] + v[:-1]) / 2 for v in fine]
    ix, iy = (np.searchsorted(v, middle) - 1 for v, middle in zip((xs, ys), middles))
    near = [((m[:, None] > v[:-1] - distance) & (m[:, None] < v[1:] + distance)).astype(int)
            for v, m in zip((xs, ys), middles)]
    coarse_areas, fine_areas = np.outer(np.diff(xs), np.diff(ys)), np.outer(np.diff(fine[0]), np.diff(fine[1]))
    result = []
    for layer in range(len(material)):
        below = material[layer - 1] if layer else np.zeros_like(material[0])
        grown = near[0] @ below.astype(int) @ near[1].T > 0
        above = (material[layer] & ~islands[layer])[np.ix_(ix, iy)] & ~grown
        result.append((coarse_areas[material[layer]].sum(), coarse_areas[material[layer] & ~below].sum(),
                       fine_areas[above].sum()))
    return result


# Known bodies

PLATE = solid(0, 0, 0, 20, 20, 2)
WALL = solid(0, 0, 1, 3, 20, 12)
ROOF = solid(0, 0, 10, 20, 20, 12)
BLOCK = solid(0, 0, 0, 20, 20, 12)
FEET = [solid(0, 0, -2, 2, 2, 1), solid(18, 18, -2, 20, 20, 1), solid(0, 18, -2, 2, 20, 1), solid(18, 0, -2, 20, 2, 1)]
THIRD = 1 / 3


class Island:
    """Layers from the first one to that below `top`, where it joins or ends."""

    def __init__(self, layer, top, area, volume, joins=True, centre=None, largest=None):
        self.layer, self.top, self.area, self.volume, self.centre = layer, top, area, volume, centre
        self.largest, self.kind = largest, "joins" if joins else "ends"


class Cavity(Island):
    kind = None

    def __init__(self, layer, top, area, volume, kind="cup", centre=None, largest=None):
        super().__init__(layer, top, area, volume, True, centre, largest)
        self.kind = kind


def trap(*arguments, **keywords):
    return Cavity(*arguments, kind="trap", **keywords)


def on_plate(*arguments, opens=False, **keywords):
    return Cavity(*arguments, kind="on plate, opens" if opens else "on plate", **keywords)


class Case:
    """A body, the options, all regions that are to be found, and other figures. `turns` is false if rounding decides."""

    def __init__(self, name, bodies, found=(), options=(), turns=True, **figures):
        self.name, self.bodies, self.found, self.options, self.turns = name, bodies, list(found), list(options), turns
        self.figures = figures


def frustum_volume(layers, area):
    return sum(area(layer + 0.5) for layer in layers)


HANGING = pyramid(10, 10, 4, 10.5, 0.5, 3.75)  # at height z: half an edge of 0.5 + (z - 4) / 2

ISLANDS = [
    Case("a box that stands on the plate", [PLATE]),
    Case("a box on a box", [PLATE, solid(3, 3, 1, 9, 9, 5)]),
    Case("a box that joins a roof", [PLATE, WALL, ROOF, solid(8, 8, 4, 8 + THIRD, 11 + THIRD, 11)],
         [Island(4, 10, 10 / 9, 60 / 9, centre=(8 + THIRD / 2, 9.5 + THIRD / 2))]),
    Case("a box that joins a wall sideways", [PLATE, WALL, solid(8, 8, 4, 12, 12, 8), solid(2, 9, 6, 9, 11, 8)],
         [Island(4, 6, 16, 32)]),
    Case("a box that never joins", [PLATE, solid(8, 8, 4, 8 + THIRD, 11, 7)], [Island(4, 7, 1, 3, joins=False)], empty_layers=2),
    Case("one layer of an island", [PLATE, WALL, solid(8, 8, 4, 10, 11, 5)], [Island(4, 5, 6, 6, joins=False)]),
    Case("touches the layer below in a point", [PLATE, solid(2, 2, 1, 6, 6, 4), solid(6, 6, 4, 9, 9, 6)],
         [Island(4, 6, 9, 18, joins=False)]),
    Case("touches the layer below along an edge", [PLATE, solid(2, 2, 1, 6, 6, 4), solid(6, 3, 4, 9, 5, 6)],
         [Island(4, 6, 6, 12, joins=False)]),
    Case("a sliver of 1e-3 mm carries", [PLATE, solid(2, 2, 1, 6, 6, 4), solid(5.999, 3, 4, 9, 5, 6)]),
    Case("a sliver of 1e-6 mm carries", [PLATE, solid(2, 2, 1, 6, 6, 4), solid(5.999999, 3, 4, 9, 5, 6)]),
    Case("a gap of 1e-6 mm does not carry", [PLATE, solid(2, 2, 1, 6, 6, 4), solid(6.000001, 3, 4, 9, 5, 6)],
         [Island(4, 6, 5.999998, 11.999996, joins=False)]),
    Case("two islands meet before they join",
         [PLATE, WALL, ROOF, solid(6, 6, 4, 8, 8, 9), solid(12, 6, 5, 15, 8, 9), solid(6, 6, 7, 15, 8, 11)],
         [Island(4, 10, 4, 4 * 3 + 18 * 3, largest=18), Island(5, 7, 6, 12)]),
    Case("three islands in a chain",
         [PLATE, solid(4, 4, 4, 6, 6, 9), solid(8, 4, 5, 10, 6, 9), solid(12, 4, 3, 14, 6, 9), solid(4, 4, 7, 10, 6, 9),
          solid(8, 4, 8, 14, 6, 9)],
         [Island(3, 9, 4, 4 * 5 + 20, joins=False), Island(4, 8, 4, 12 + 12), Island(5, 7, 4, 8)], empty_layers=1),
    Case("an island in a hole, joined by a lid",
         [*tube(0, 0, 0, 20, 20, 10), solid(5, 5, 3, 9, 9, 9), solid(0, 0, 8, 20, 20, 10)],
         [Island(3, 8, 16, 80), on_plate(0, 8, 324, 324 * 8 - 80)]),
    Case("an island that splits in two",
         [PLATE, WALL, ROOF, solid(5, 5, 4, 15, 7, 6), solid(5, 5, 5, 7, 7, 11), solid(13, 5, 5, 15, 7, 11)],
         [Island(4, 10, 20, 40 + 8 * 4, largest=20)]),
    Case("one arm of an island joins before the other", [PLATE, WALL, ROOF, solid(5, 5, 4, 15, 7, 5), solid(5, 5, 4, 7, 7, 11),
         solid(13, 5, 4, 15, 7, 9), solid(2, 5, 7, 7, 7, 9)], [Island(4, 7, 20, 20 + 8 * 2)]),
    Case("a gate", [solid(0, 0, 0, 2, 4, 8), solid(8, 0, 0, 10, 4, 8), solid(0, 0, 6, 10, 4, 8)], overhangs=1),
    Case("a table", [solid(0, 0, 0, 1, 1, 6), solid(9, 0, 0, 10, 1, 6), solid(0, 9, 0, 1, 10, 6), solid(9, 9, 0, 10, 10, 6),
         solid(0, 0, 5, 10, 10, 7)], overhangs=1),
    Case("a table with a short leg", [solid(0, 0, 0, 1, 1, 6), solid(9, 0, 0, 10, 1, 6), solid(0, 9, 0, 1, 10, 6),
         solid(9, 9, 3, 10, 10, 6), solid(0, 0, 5, 10, 10, 7)], [Island(3, 5, 1, 2)]),
    Case("a loop that hangs from a roof",
         [PLATE, WALL, ROOF, solid(6, 6, 4, 14, 8, 6), solid(6, 6, 4, 8, 8, 11), solid(12, 6, 4, 14, 8, 11)],
         [Island(4, 10, 16, 32 + 8 * 4)]),
    Case("stairs that meet in edges", [solid(2 * k, 0, k, 2 * k + 2, 3, k + 1) for k in range(5)],
         [Island(k, k + 1, 6, 6, joins=False) for k in range(1, 5)]),
    Case("stairs that overlap", [solid(2 * k, 0, k, 2 * k + 2.125, 3, k + 1) for k in range(5)]),
    Case("diagonal boxes that meet in points", [solid(2 * k, 2 * k, k, 2 * k + 2, 2 * k + 2, k + 1) for k in range(5)],
         [Island(k, k + 1, 4, 4, joins=False) for k in range(1, 5)]),
    Case("a tip that hangs from a roof", [PLATE, WALL, ROOF, HANGING],
         [Island(4, 10, 1.5 ** 2, frustum_volume(range(4, 10), lambda z: (1 + (z - 4)) ** 2), largest=6.5 ** 2)]),
    Case("a prism of seven corners", [PLATE, WALL, ROOF, prism(polygon(11, 11, 2, 7), 4, 11)],
         [Island(4, 10, polygon_area(2, 7), 6 * polygon_area(2, 7), centre=(11, 11))]),
    Case("bodies that overlap", [PLATE, solid(4, 4, 4, 8, 8, 6), solid(6, 6, 4, 10, 10, 6)], [Island(4, 6, 28, 56, joins=False)],
         empty_layers=2),
    Case("a body within a body",
         [PLATE, WALL, solid(4, 4, 4, 12, 12, 8), solid(6, 6, 5, 8, 8, 7)], [Island(4, 8, 64, 256, joins=False)]),
    Case("space where there is no body", [PLATE, space(4, 4, 4, 12, 12, 8), solid(14, 4, 1, 16, 6, 8)]),
    Case("everything above an empty gap", [PLATE, solid(0, 0, 4, 20, 20, 5), solid(4, 4, 4, 8, 8, 8)],
         [Island(4, 8, 400, 400 + 48, joins=False, largest=400)], empty_layers=2),
    Case("two bodies above an empty gap", [PLATE, solid(0, 0, 4, 5, 5, 6), solid(6, 0, 4, 8, 5, 7), solid(6, 6, 5, 8, 7, 6)],
         [Island(4, 6, 25, 50, joins=False), Island(4, 7, 10, 30, joins=False), Island(5, 6, 2, 2, joins=False)], empty_layers=2),
    Case("islands that carry each other's overhangs", [PLATE, solid(4, 4, 4, 6, 6, 6), solid(5, 4, 6, 9, 6, 8)],
         [Island(4, 8, 4, 8 + 16, joins=False, largest=8)],
         empty_layers=2),
    Case("no face below and none above",
         [(PLATE[0], PLATE[1][4:]), WALL, (solid(8, 8, 4, 12, 12, 8)[0], solid(8, 8, 4, 12, 12, 8)[1][4:])],
         [Island(4, 8, 16, 64, joins=False)]),
]

OVERLAPS_BY_2 = [PLATE, solid(2, 2, 1, 6, 6, 4), solid(5, 3, 4, 9, 5, 6)]
OVERLAPS_BY_1_AND_1 = [PLATE, solid(2, 2, 1, 6, 6, 4), solid(9, 2, 1, 12, 6, 4), solid(5, 3, 4, 10, 4, 6)]
TOUCHES = [
    Case("--touch just below the overlap", OVERLAPS_BY_2, options=["--touch", 1.99]),
    Case("--touch is the overlap", OVERLAPS_BY_2, [Island(4, 6, 8, 16, joins=False)], ["--touch", 2], turns=False),
    Case("--touch just above the overlap", OVERLAPS_BY_2, [Island(4, 6, 8, 16, joins=False)], ["--touch", 2.01]),
    Case("--touch below the sum of two overlaps", OVERLAPS_BY_1_AND_1, options=["--touch", 1.5]),
    Case("--touch above the sum of two overlaps", OVERLAPS_BY_1_AND_1, [Island(4, 6, 5, 10, joins=False)], ["--touch", 2.01]),
    Case("--touch does not open a trap", [BLOCK, space(5, 5, 3, 9, 9, 7)], [trap(3, 7, 16, 64)], ["--touch", 100]),
]

CHAMBERS = [space(3, 3, 3, 7, 7, 8), space(12, 3, 4, 16, 7, 8)]
SPIRAL = [(2, 2, 18, 4, 2), (16, 2, 18, 18, 3), (2, 16, 18, 18, 4), (2, 6, 4, 18, 5), (2, 6, 14, 8, 6), (12, 6, 14, 14, 7),
          (6, 12, 14, 14, 8)]


def spiral(first, last):
    """A channel that rises by a layer from each of its parts to the next, which stands on its end."""
    return [space(x0, y0, z, x1, y1, z + 1) for x0, y0, x1, y1, z in SPIRAL[first:last]]


def spiral_volume(first, last):
    return sum((x1 - x0) * (y1 - y0) for x0, y0, x1, y1, _ in SPIRAL[first:last])


CAVITIES = [
    Case("a glass", [solid(0, 0, 0, 6, 6, 9), space(1, 1, 2, 5, 5, 9)], [Cavity(2, 9, 16, 112, centre=(3, 3))]),
    Case("a glass upside down", [solid(0, 0, 0, 6, 6, 9), space(1, 1, 0, 5, 5, 7)], [on_plate(0, 7, 16, 112)]),
    Case("a glass upside down on feet", [*FEET, BLOCK, space(4, 4, 0, 12, 12, 8)]),
    Case("a closed box", [solid(0, 0, 0, 6, 6, 9), space(1, 1, 2, 5, 4 + THIRD, 7)], [trap(2, 7, 40 / 3, 200 / 3)]),
    Case("a cavity with a hole to the plate", [BLOCK, space(4, 4, 3, 9, 9, 8), space(5, 5, 0, 6, 6, 3)],
         [on_plate(0, 8, 1, 3 + 125, largest=25)]),
    Case("a cavity with a hole below, on feet", [*FEET, BLOCK, space(4, 4, 3, 9, 9, 8), space(5, 5, 0, 6, 6, 3)]),
    Case("a cavity with a hole above", [BLOCK, space(4, 4, 3, 9, 9, 8), space(5, 5, 8, 6, 6, 12)],
         [Cavity(3, 12, 25, 125 + 4, largest=25)]),
    Case("a cavity with a hole sideways at its floor", [BLOCK, space(4, 4, 3, 9, 9, 8), space(8, 5, 3, 21, 6, 4)]),
    Case("a cavity with a hole sideways halfway",
         [BLOCK, space(4, 4, 3, 9, 9, 8), space(8, 5, 5, 21, 6, 6)], [Cavity(3, 5, 25, 50)]),
    Case("a cavity with a hole sideways at its roof",
         [BLOCK, space(4, 4, 3, 9, 9, 8), space(8, 5, 7, 21, 6, 8)], [Cavity(3, 7, 25, 100)]),
    Case("a cavity with a hole sideways above its roof",
         [BLOCK, space(4, 4, 3, 9, 9, 8), space(8, 5, 8, 21, 6, 9)], [Cavity(3, 8, 25, 125)]),
    Case("two chambers", [BLOCK, *CHAMBERS], [trap(3, 8, 16, 80), trap(4, 8, 16, 64)]),
    Case("two chambers that are connected above", [BLOCK, *CHAMBERS, space(6, 4, 7, 13, 5, 9)],
         [trap(3, 9, 16, 80 + 64 + 5 + 7, centre=(5, 5), largest=37)]),
    Case("two chambers that are connected below",
         [BLOCK, *CHAMBERS, space(4, 4, 2, 15, 5, 4)], [trap(2, 8, 11, 11 + 24 + 4 * 32, largest=32)]),
    Case("two chambers, one with a hole above",
         [BLOCK, *CHAMBERS, space(13, 4, 8, 14, 5, 12)], [trap(3, 8, 16, 80), Cavity(4, 12, 16, 64 + 4)]),
    Case("connected chambers, one with a hole sideways", [BLOCK, *CHAMBERS, space(6, 4, 6, 13, 5, 9), space(15, 4, 5, 21, 5, 6)],
         [Cavity(4, 5, 16, 16), Cavity(3, 6, 16, 48)]),
    Case("a trap within a trap, and a ball",
         [BLOCK, space(2, 2, 2, 18, 18, 10), solid(4, 4, 4, 16, 16, 9), space(6, 6, 5, 14, 14, 8), solid(8, 8, 6, 12, 12, 7)],
         [Island(4, 9, 144, 144 * 5 - 64 * 3, joins=False, largest=144), trap(2, 10, 256, 256 * 8 - 144 * 5, largest=256),
          trap(5, 8, 64, 64 * 3 - 16, largest=64), Island(6, 7, 16, 16, joins=False)]),
    Case("a ball in a trap that joins its roof", [BLOCK, space(4, 4, 2, 14, 14, 9), solid(6, 6, 5, 10, 10, 10)],
         [Island(5, 9, 16, 64), trap(2, 9, 100, 700 - 64)]),
    Case("a channel winding up within a block", [BLOCK, *spiral(0, 7)], [trap(2, 9, 32, spiral_volume(0, 7), largest=32)]),
    Case("a channel winding up from outside", [BLOCK, *spiral(0, 7), space(17, 2, 2, 21, 4, 3)]),
    Case("a channel winding up to the top",
         [BLOCK, *spiral(0, 7), space(6, 12, 9, 8, 14, 12)], [Cavity(2, 12, 32, spiral_volume(0, 7) + 12)]),
    Case("a channel winding down from outside halfway",
         [BLOCK, *spiral(0, 7), space(17, 16, 4, 21, 18, 5)], [Cavity(2, 4, 32, spiral_volume(0, 2))]),
    Case("a plate with holes", [PLATE, *(space(x, y, 0, x + 1, y + 1, 2) for x in (2, 6, 10) for y in (3, 7))],
         [on_plate(0, 2, 1, 2, opens=True)] * 6),
    Case("a plate with holes on feet", [*FEET, PLATE, *(space(x, y, 0, x + 1, y + 1, 2) for x in (2, 6, 10) for y in (3, 7))]),
    Case("a trap of seven corners", [BLOCK, prism(polygon(9, 9, 4, 7), 3, 7, space=True)],
         [trap(3, 7, polygon_area(4, 7), 4 * polygon_area(4, 7), centre=(9, 9))]),
    Case("a funnel", [BLOCK, (pyramid(10, 10, 4, 12, 1, 9)[0], [(a, c, b) for a, b, c in pyramid(10, 10, 4, 12, 1, 9)[1]])],
         [Cavity(4, 12, 9, frustum_volume(range(4, 12), lambda z: 4 * (1 + z - 4) ** 2), largest=17 ** 2)]),
    Case("a pipe that goes up and down again, on feet",
         [*FEET, BLOCK, space(4, 4, 0, 6, 6, 8), space(12, 4, 3, 14, 6, 8), space(4, 4, 7, 14, 6, 8)],
         [Cavity(3, 7, 4, 16)]),
    Case("a pipe that goes down and up again",
         [BLOCK, space(4, 4, 3, 6, 6, 12), space(12, 4, 3, 14, 6, 12), space(4, 4, 2, 14, 6, 4)],
         [Cavity(2, 12, 20, 40 + 8 * 8, largest=20)]),
    Case("a trap that touches the space outside along an edge",
         [BLOCK, space(4, 4, 3, 8, 8, 5), space(8, 4, 5, 21, 8, 7)], [trap(3, 5, 16, 32)]),
    Case("a trap that touches the space outside in a point",
         [BLOCK, space(4, 4, 3, 8, 8, 5), space(8, 8, 5, 21, 10, 7)], [trap(3, 5, 16, 32)]),
    Case("a sliver of 1e-3 mm opens", [BLOCK, space(4, 4, 3, 8, 8, 5), space(7.999, 4, 5, 21, 8, 7)], [Cavity(3, 5, 16, 32)]),
    Case("a wall of 1e-6 mm closes", [BLOCK, space(4, 4, 3, 8, 8, 5), space(8.000001, 4, 3, 21, 8, 5)], [trap(3, 5, 16, 32)]),
    Case("a cup in a cup", [BLOCK, space(2, 2, 2, 18, 18, 12), *tube(6, 6, 1, 14, 14, 12)],
         [Cavity(2, 12, 256 - 64, 1920), Cavity(2, 12, 36, 360)]),
    Case("a cup that an empty gap opens", [solid(0, 0, 0, 20, 20, 6), space(4, 4, 3, 8, 8, 6), solid(0, 0, 7, 20, 20, 9)],
         [Cavity(3, 6, 16, 48), Island(7, 9, 400, 800, joins=False)], empty_layers=1),
    Case("a ring above an empty gap", [PLATE, *tube(2, 2, 4, 12, 12, 7)], [Island(4, 7, 36, 108, joins=False)], empty_layers=2),
    Case("a cup that branches",
         [BLOCK, space(4, 4, 3, 16, 6, 4), space(4, 4, 4, 6, 6, 12), space(14, 4, 4, 16, 6, 7), space(15, 4, 6, 21, 6, 7)],
         [Cavity(3, 6, 24, 24 + 8 * 2)]),
]

AREAS = [
    Case("walls of 46 degrees", [pyramid(0, 0, 0, 6, 2, 2 + 6 / math.tan(math.radians(46)))], overhangs=0),
    Case("walls of 45 degrees", [pyramid(0, 0, 0, 6, 2, 8)], overhangs=0),
    Case("walls of 44 degrees", [pyramid(0, 0, 0, 6, 2, 2 + 6 / math.tan(math.radians(44)))], overhangs=5),
    Case("walls of 44 degrees where 43 are allowed", [pyramid(0, 0, 0, 6, 2, 2 + 6 / math.tan(math.radians(44)))],
         options=["--overhang-angle", 43], overhangs=0),
    Case("walls of 60 degrees",
         [pyramid(0, 0, 0, 6, 2, 2 + 6 / math.tan(math.radians(60)))], options=["--overhang-angle", 60], overhangs=0),
    Case("walls of 59 degrees where 60 are needed", [pyramid(0, 0, 0, 6, 2, 2 + 6 / math.tan(math.radians(59)))],
         options=["--overhang-angle", 60], overhangs=5),
    Case("walls of 45 degrees that lean inwards", [pyramid(0, 0, 0, 6, 8, 2)], overhangs=0),
    Case("a lid over a hole", [prism(polygon(0, 0, 9, 96), 0, 6), prism(polygon(0, 0, 6, 96), 0, 5, space=True)],
         [on_plate(0, 5, polygon_area(6, 96), 5 * polygon_area(6, 96))],
         overhangs=1, widest=6, overhang_area=(polygon_area(5, 96), 0.01)),
    Case("a bridge between pillars", [solid(0, 0, 0, 3, 4, 5), solid(13, 0, 0, 16, 4, 5), solid(0, 0, 5, 16, 4, 7)],
         overhangs=1, widest=5, overhang_area=(32, 0.005)),
    Case("a plank", [solid(0, 0, 0, 3, 4, 5), solid(0, 0, 5, 10, 4, 6)], overhangs=1, widest=7, overhang_area=(24, 0.005)),
    Case("two planks",
         [solid(0, 0, 0, 3, 4, 5), solid(-9, 0, 5, 10, 4, 6)], overhangs=2, widest=9, overhang_area=(24 + 32, 0.005)),
    Case("a plate on a pillar", [solid(4, 4, 0, 6, 6, 5), solid(0, 0, 5, 10, 10, 6)], overhangs=1, widest=math.hypot(4, 4),
         overhang_area=(100 - 16, 0.005), area_jumps=1),
    Case("a step of less than half", [solid(0, 0, 0, 10, 10, 2), solid(0, 0, 2, 10, 14, 4)], area_jumps=0),
    Case("a step of more than half", [solid(0, 0, 0, 10, 10, 2), solid(0, 0, 2, 10, 16, 4)], area_jumps=1),
    Case("steps inwards", [solid(0, 0, 0, 10, 10, 2), solid(0, 0, 2, 4, 4, 4)], area_jumps=0),
    Case("two steps", [solid(0, 0, 0, 4, 10, 2), solid(0, 0, 2, 10, 10, 4), solid(0, 0, 4, 10, 20, 6)], area_jumps=2),
    Case("three gaps", [solid(0, 0, k, 10, 10, k + 1) for k in (0, 2, 5, 9)],
         [Island(k, k + 1, 100, 100, joins=False) for k in (2, 5, 9)], empty_layers=1 + 2 + 3, overhangs=0),
]


# Part of a layer of trimesh__cycloidal.ply.
NEARLY_MEETING = [
    [1.6, -0.3, 0.85, 1.5, 0.3, 0.8, 0.2, 0.6],
    [0.69503, 1.299919, 0.7009008845174772, 1.3000399352388485, 0.7031850218772888, 1.3000869750976562, 0.7, 1.32],
    [0.704, 1.3003, 0.7031850218772888, 1.3000869750976562, 0.6959454270023167, 1.2999378818221223, 0.7, 1.3],
    [0.71, 0.4434, 0.6956, 0.498, 0.7, 0.5],
]


def kind_of(region):
    if "joins" in region:
        return "joins" if region["joins"] else "ends"
    if region["on_plate"]:
        return "on plate, opens" if region["opens"] else "on plate"
    return "cup" if region["opens"] else "trap"


class CheckTest(ProgramTest):
    def check(self, *arguments):
        return self.run_program("check", *arguments, "--json", "-q").json()


class KnownTest(CheckTest):
    """What is in a body is found, and nothing else: as it is, as an STL file, and turned far from the origin."""

    def assert_close(self, found, expected, relative, message):
        self.assertAlmostEqual(found, expected, delta=relative * max(1, abs(expected)), msg=message)

    def compare(self, case, bodies, place, relative, name):
        file = self.write(name, stl(bodies) if name.endswith(".stl") else obj(bodies))
        result = self.check(file, "--layer-height", 1, *case.options)
        low = min(z for vertices, _ in bodies for _, _, z in vertices)
        found = result["list_of_islands"] + result["list_of_cavities"]
        below = 2 if low < 0 else 0  # layers of feet below z = 0
        message = f"{case.name}, {name}: {json.dumps(found)}"
        keys = [(r["layer"] - below, round(r["z"][1] - low) - below, kind_of(r)) for r in found]
        expected = [(r.layer, r.top, r.kind) for r in case.found]
        self.assertEqual(sorted(keys), sorted(expected), message)
        left = list(zip(keys, found))
        for region in case.found:
            # Of several with the same layers, that with the nearest volume.
            key = (region.layer, region.top, region.kind)
            nearest = min((k for k in left if k[0] == key), key=lambda k: abs(k[1]["volume_mm3"] - region.volume))
            left.remove(nearest)
            best = nearest[1]
            self.assert_close(best["z"][0] - low, best["layer"], 1e-9, message)
            self.assert_close(best["area_mm2"], region.area, relative, message)
            self.assert_close(best["volume_mm3"], region.volume, relative, message)
            if region.largest is not None:
                self.assert_close(best["largest_mm2"], region.largest, relative, message)
            if region.centre is not None:
                for value, wanted in zip(best["centre"], place(*region.centre)):
                    self.assert_close(value, wanted, 1e-6 if name.endswith(".stl") else 1e-8, message)
        for word, kinds in (("islands", ["joins", "ends"]), ("traps", ["trap"]),
                            ("cups", ["cup", "on plate", "on plate, opens"])):
            regions = [r for r in case.found if r.kind in kinds]
            self.assertEqual(result[word], len(regions), message)
            self.assert_close(result[f"{word}_mm3"], sum(r.volume for r in regions), relative, message)
        figures = {"empty_layers": 0, **case.figures}
        for key in ("empty_layers", "overhangs", "area_jumps"):
            if key in figures:
                self.assertEqual(result[key], figures[key], f"{message} {key}")
        if "overhang_area" in figures:
            wanted, tolerance = figures["overhang_area"]
            self.assertAlmostEqual(result["overhangs_mm2"], wanted, delta=tolerance * wanted, msg=message)
        if "widest" in figures:
            stats = json.loads(self.succeed("check", file, "--layer-height", 1, *case.options, "--stats", "-", "-q").text)
            self.assertAlmostEqual(max(layer["overhang_mm"] for layer in stats["layers"]), figures["widest"],
                                   delta=0.05 * figures["widest"], msg=message)

    def compare_all(self, cases):
        for index, case in enumerate(cases):
            with self.subTest(case.name):
                self.compare(case, case.bodies, lambda x, y: (x, y), 1e-9, "part.obj")
                # STL has 24 binary digits: volumes of bodies with other coordinates differ by some 1e-7 of 20 mm. It may close
                # what is only 1e-6 mm wide.
                if "1e-6" not in case.name:
                    self.compare(case, case.bodies, lambda x, y: (x, y), 1e-5, "part.stl")
                if case.turns:
                    place = turned(17.3 + 23 * index, 3e4 - 777.7 * index, -1e4 / 3)
                    # At 3e4 mm, coordinates are multiples of 4e-12 mm, which is 1e-9 of an area of 1 mm2 or more.
                    self.compare(case, moved(case.bodies, place), place, 1e-9, "far.obj")

    def test_exit_code_of_strict(self):
        for name, bodies, code in (("clean", [PLATE], 0), ("island", [PLATE, WALL, solid(8, 8, 4, 12, 12, 8)], 4),
                                   ("cup", [BLOCK, space(4, 4, 3, 8, 8, 12)], 4), ("trap", [BLOCK, space(4, 4, 3, 8, 8, 9)], 4)):
            self.write("part.obj", obj(bodies))
            self.assertEqual(self.run_program("check", "part.obj", "--strict").code, code, name)

    def test_islands(self):
        self.compare_all(ISLANDS)

    def test_touching_areas(self):
        self.compare_all(TOUCHES)

    def test_cavities(self):
        self.compare_all(CAVITIES)

    def test_overhangs_steps_and_gaps(self):
        self.compare_all(AREAS)

    def test_contours_that_cross_and_almost_meet(self):
        """Rings of a layer that share a vertex, with others that cross and pass by at distances of 1e-16 mm."""
        layer = {"index": 0, "z": 0.5, "bottom": 0, "top": 1, "parts": [{"rings": NEARLY_MEETING}]}
        self.write("layer.json", json.dumps({"format": "lamella layers", "version": 1, "units": "mm",
                                             "parts": [{"label": "part"}], "layers": [layer]}))
        self.assertEqual(self.check("layer.json")["islands"], 0)

    def test_islands_that_began_in_the_same_layer(self):
        """Which of them goes on is not determined, but together they have what both have."""
        bodies = [PLATE, WALL, ROOF, solid(6, 6, 4, 8, 8, 9), solid(12, 6, 4, 15, 8, 9), solid(6, 6, 7, 15, 8, 11)]
        for place in (turned(0), turned(180)):
            result = self.check(self.write("part.obj", obj(moved(bodies, place))), "--layer-height", 1)
            found = result["list_of_islands"]
            self.assertEqual([(r["layer"], round(r["z"][1])) for r in sorted(found, key=lambda r: r["z"])], [(4, 7), (4, 10)])
            self.assertEqual(sorted(round(r["area_mm2"], 9) for r in found), [4, 6])
            self.assertAlmostEqual(result["islands_mm3"], 10 * 3 + 18 * 3)

    def test_bodies_that_stand_side_by_side_are_one(self):
        """Walls that coincide keep bodies together, and enclose what is between them, also where turning rounds their corners."""
        shelf = [solid(0, 0, 0, 10, 3, 6), solid(2, 3, 2, 7, 5, 4)]
        glass = [solid(0, 0, 0, 10, 10, 1), solid(0, 0, 1, 9, 1, 9), solid(1, 9, 1, 10, 10, 9), solid(0, 1, 1, 1, 10, 9),
                 solid(9, 0, 1, 10, 9, 9)]
        wrong = []
        for degrees in (0, 17.3, 33, 45, 90, 101, 200.1, 271):
            for name, bodies, islands, cups in (("shelf", shelf, 0, 0), ("glass", glass, 0, 512)):
                result = self.check(self.write("part.obj", obj(moved(bodies, turned(degrees)))), "--layer-height", 1)
                if result["islands"] != islands or abs(result["cups_mm3"] - cups) > 1e-6:
                    wrong.append((name, degrees, result["islands"], result["cups_mm3"]))
        self.assertEqual(wrong, [])


class BoxesTest(CheckTest):
    """Towers of random boxes, solid or space, against the search, which is exact for them."""

    def compare(self, boxes, place, touch, message, relative=1e-8):
        search = search_boxes(boxes, touch)
        bodies = moved([(solid if box[6] > 0 else space)(*box[:6]) for box in boxes], place)
        self.write("boxes.obj", obj(bodies))
        angle = random.Random(len(boxes)).choice([30, 45, 60])
        options = ["--layer-height", 1, "--touch", touch, "--overhang-angle", angle]
        stats = json.loads(self.succeed("check", "boxes.obj", *options, "--stats", "-", "-q").text)
        result = stats["check"]
        self.assertEqual(len(stats["layers"]), max(box[5] for box in boxes))
        for regions, found in ((search.islands, result["list_of_islands"]), (search.cavities, result["list_of_cavities"])):
            self.assertEqual(len(found), len(regions), message)
            expected = [(r.layer, r.top + 1, r.ended, r.on_plate, r.volume, r.largest) for r in regions if len(r.equals) == 1]
            given = [(r["layer"], round(r["z"][1]), r.get("joins", r.get("opens")), r.get("on_plate", False),
                      r["volume_mm3"], r["largest_mm2"]) for r in found]
            for region in expected:
                near = [g for g in given if g[:4] == region[:4] and np.allclose(g[4:], region[4:], rtol=relative, atol=relative)]
                self.assertTrue(near, f"{message}: {region} of {given}")
                given.remove(near[0])
            # Which of two that began in the same layer goes on is not determined, but together they have what both have.
            volume = sum(r.volume for r in regions)
            self.assertAlmostEqual(sum(r["volume_mm3"] for r in found), volume, delta=relative * max(1, volume), msg=message)
            if len(expected) == len(regions):
                def ordered(rows):
                    return np.array(sorted(rows, key=lambda row: [round(v, 4) for v in row])).reshape(-1, 4)
                np.testing.assert_allclose(ordered((r["layer"], *r["centre"], r["area_mm2"]) for r in found),
                                           ordered((r.layer, *place(r.x, r.y), r.area) for r in regions),
                                           rtol=1e-8, atol=1e-6, err_msg=message)
        distance = 1 / math.tan(math.radians(angle))
        least, most = (areas_of_boxes(boxes, search, d, touch) for d in (SLACK * distance, distance))
        for index, (low, high, layer) in enumerate(zip(least, most, stats["layers"])):
            if low[0] > 0 and index > 0:
                text = f"{message}, layer {index}: {layer}"
                self.assertAlmostEqual(layer["area_mm2"], low[0], delta=relative * max(1, low[0]), msg=text)
                self.assertAlmostEqual(layer["exposed_mm2"], low[1], delta=relative * max(1, low[0]), msg=text)
                self.assertGreaterEqual(layer["overhang_mm2"], low[2] - 1e-7 * max(1, low[0]), text)
                self.assertLessEqual(layer["overhang_mm2"], high[2] + 1e-7 * max(1, low[0]), text)
        return len(search.islands) + len(search.cavities)

    def test_boxes_in_general_position(self):
        found = 0
        for seed in range(40):
            numbers = random.Random(seed)
            size, boxes = numbers.choice([5, 10, 20]), []
            for _ in range(numbers.randint(3, 25)):
                (x0, x1), (y0, y1) = (sorted(numbers.uniform(0, size) for _ in range(2)) for _ in range(2))
                z0, z1 = sorted(numbers.sample(range(13), 2))
                boxes.append((x0, y0, z0, x1, y1, z1, -1 if numbers.random() < 0.3 else 1))
            # A foot below and a mast above all others, so that layers are counted from z = 0 and to the last box.
            boxes += [(0, 0, 0, size, size, numbers.randint(1, 12), 1), (size + 1, 0, 0, size + 2, 1, 13, 1)]
            place = turned(numbers.uniform(0, 360), *numbers.choice([(0, 0), (1000.1, -333.3), (1e5, 1e5)]))
            found += self.compare(boxes, place, numbers.choice([0, 0, 0.5, 2, 10]), f"seed {seed}")
        self.assertGreater(found, 200)

    def test_boxes_that_meet_in_faces_edges_and_points(self):
        found = 0
        for seed in range(40):
            numbers = random.Random(seed)
            nx, ny, nz, share = numbers.randint(3, 9), numbers.randint(3, 9), numbers.randint(3, 9), numbers.uniform(0.3, 0.85)
            boxes = [(x, y, z, x + 1, y + 1, z + 1, 1) for z in range(nz) for y in range(ny) for x in range(nx)
                     if numbers.random() < share]
            boxes.append((nx + 1, 0, 0, nx + 2, 1, nz, 1))
            found += self.compare(boxes, turned(0, *numbers.choice([(0, 0), (1000.5, -333.25)])), 0, f"seed {seed}")
        self.assertGreater(found, 200)

    def test_boxes_whose_walls_coincide_with_those_below(self):
        """Turning rounds their corners: walls that coincided cross at distances of 1e-15 mm, and must not overlap by that."""
        found = 0
        for seed in range(20):
            numbers, boxes = random.Random(seed), []
            for z in range(9):
                across, along = numbers.randint(0, 2), numbers.randint(0, 2)
                corners = [(3 * i + across, 3 * j + along) for i in range(4) for j in range(4) if numbers.random() < 0.5]
                boxes += [(x, y, z, x + numbers.randint(1, 2), y + numbers.randint(1, 2), z + 1, 1) for x, y in corners]
            if seed % 2:
                boxes = [(-1, -1, 0, 16, 16, 9, 1)] + [(*box[:6], -1) for box in boxes if numbers.random() < 0.7]
            boxes.append((20, 0, 0, 21, 1, 9, 1))
            place = turned(numbers.uniform(0, 360), *numbers.choice([(0, 0), (1000.1, -333.3)]))
            found += self.compare(boxes, place, 0, f"seed {seed}", 1e-7)
        self.assertGreater(found, 400)

    def test_result_does_not_depend_on_threads_mirroring_and_format(self):
        found = 0
        for seed in range(4):
            numbers = random.Random(seed)
            bodies = [solid(0, 0, 0, 12, 12, 4), space(1.5, 1.25, 1, 9, 9, 3), *tube(20, 0, 0, 26, 6, 13)]
            for _ in range(12):
                x, y, z = numbers.uniform(0, 10), numbers.uniform(0, 10), numbers.randint(0, 9)
                bodies.append(solid(x, y, z, x + numbers.uniform(1, 4), y + numbers.uniform(1, 4), z + numbers.randint(1, 4)))
            self.write("part.obj", obj(bodies))
            options = ["--layer-height", 0.5, "--json", "-q"]
            texts = [self.run_program("check", "part.obj", *options, "--threads", n).text for n in (1, 3)]
            self.assertEqual(texts[0], texts[1])
            plain = json.loads(texts[0])
            found += plain["islands"] + plain["cups"] + plain["traps"]
            mirrored = self.run_program("check", "part.obj", *options, "--scale", "-1,1,1").json()
            for kind in ("list_of_islands", "list_of_cavities"):
                rows = [sorted((r["layer"], kind_of(r), *r["z"], r["area_mm2"], r["largest_mm2"], r["volume_mm3"],
                                sign * r["centre"][0], r["centre"][1]) for r in result[kind])
                        for sign, result in ((1, plain), (-1, mirrored))]
                for one, other in zip(*rows, strict=True):
                    self.assertEqual(one[:2], other[:2])
                    np.testing.assert_allclose(one[2:], other[2:], rtol=1e-9, atol=1e-9)
            for name, tolerance in (("part.json", 0.0), ("part.npz", 0.0), ("part.cli", 1e-3)):
                self.succeed("slice", "part.obj", "--layer-height", 0.5, "-o", name, "-q")
                again = self.check(name)
                for kind in ("list_of_islands", "list_of_cavities"):
                    self.assertEqual(*([(r["layer"], kind_of(r)) for r in result[kind]] for result in (again, plain)), name)
                    for one, other in zip(again[kind], plain[kind]):
                        if tolerance == 0:
                            self.assertEqual({**one, "z": None}, {**other, "z": None}, name)
                        # CLI has single precision, here of up to 26 mm: 2e-6 mm along walls of some 40 mm.
                        self.assertAlmostEqual(one["volume_mm3"], other["volume_mm3"], delta=1e-12 + tolerance, msg=name)
        self.assertGreater(found, 10)


# Name, number of layers, number of rows. The drive frame has walls of 0.2 mm. Meshes with gaps much thinner than a row are not
# here, such as trimesh__cycloidal.ply, whose rings are 1e-5 to 3e-3 mm apart.
PUBLIC = [
    ("3mf-samples__cube_gears_prod_req.3mf", 100, 300), ("abfab3d__gyrosphere.stl", 100, 300),
    ("admesh__fill-holes-bad.stl", 60, 300), ("compas__branches_16_closed_mid_res.stl", 100, 300),
    ("compas__simple_vase_open_low_res.stl", 80, 300), ("geomcentral__spot.ply", 100, 300),
    ("lib3mf__3mfbase11_AdjMount.3mf", 80, 300), ("lib3mf__WagonWithWheels.3mf", 80, 300),
    ("manifold__self_intersectA.obj", 100, 300), ("numpy-stl__rear_case.stl", 100, 300), ("o3dv__rook.amf", 100, 300),
    ("openfoam__body.obj", 60, 300), ("openfoam__flange.stl", 80, 300), ("openscad__issue1580-back-to-back.stl", 60, 200),
    ("openscad__multi-volume-binary.amf", 80, 300), ("openscad__sphere20face.amf", 60, 200),
    ("prusa-i3__x-carriage.stl", 75, 300), ("prusa-mini__MINI-z-carriage-front.stl", 60, 300),
    ("prusaslicer__20mmbox-CR.stl", 50, 200), ("prusaslicer__universal wall mount hole.stl", 60, 300),
    ("trimesh__idler_riser.STL", 80, 300), ("voron2__Voron_Design_Cube_v7.stl", 80, 300),
    ("voron2__a_drive_frame_lower.stl", 60, 600),
]


@unittest.skipUnless(MESHES.is_dir(), "no public meshes; set LAMELLA_SHARED")
class PublicMeshesTest(CheckTest):
    """Regions of more than a few pixels, against rows along x and along y. A gap or wall that is thinner than a row separates
    nothing if it runs along the rows: what both directions find must be found, and what is found must be in one of them."""

    def searches(self, name, rows):
        file = json.loads(self.bytes_of(name))
        thickness = [layer["top"] - layer["bottom"] for layer in file["layers"]]
        edges, layers = [np.empty((0, 4))], [np.empty(0, int)]
        for index, layer in enumerate(file["layers"]):
            for ring in (ring for part in layer["parts"] for ring in part.get("rings", [])):
                points = np.array(ring).reshape(-1, 2)
                edges.append(np.hstack((points, np.roll(points, -1, 0))))
                layers.append(np.full(len(points), index))
        edges, layers = np.concatenate(edges), np.concatenate(layers)
        extent = max(np.ptp(edges[:, :2], axis=0))
        result, pixel = [], extent / rows
        for swapped in (False, True):
            # x and y change places; the direction of rings is reversed with them, so that material stays on their left.
            turned_edges = edges[:, [3, 2, 1, 0]] if swapped else edges
            low, high = turned_edges[:, 1].min(), turned_edges[:, 1].max()
            # Not at round coordinates, at which horizontal edges lie.
            ys = np.arange(low - 0.4863 * pixel, high + pixel, pixel)
            search = Search(layers, turned_edges, thickness, ys, np.full(len(ys), pixel), 0.0, 1e-9 * extent)
            if swapped:
                for region in search.islands + search.cavities:
                    region.x, region.y = region.y, region.x
            result.append(search)
        return result, pixel

    @staticmethod
    def region_of(found, height):
        region = Region(found["layer"], *found["centre"], found["area_mm2"])
        region.volume, region.largest = found["volume_mm3"], found["largest_mm2"]
        region.top += round((found["z"][1] - found["z"][0]) / height) - 1
        region.on_plate, region.ended = found.get("on_plate", False), found.get("joins", found.get("opens"))
        return region

    @staticmethod
    def same(one, other, pixel, height):
        """Rows lose up to a pixel along a contour that runs along them; a tip of few pixels may begin some layers later. A region
        ends a layer earlier or later if what it meets there is thinner than a pixel."""
        cell = pixel ** 2
        tip = min(one.area, other.area) < 30 * cell
        if abs(one.layer - other.layer) > (4 if tip else 1) or (one.on_plate, one.ended) != (other.on_plate, other.ended):
            return False
        if not tip and math.dist((one.x, one.y), (other.x, other.y)) > 3 * pixel + 0.05 * math.sqrt(one.area):
            return False
        if tip and math.dist((one.x, one.y), (other.x, other.y)) > 15 * pixel + 2 * math.sqrt(max(one.largest, other.largest)):
            return False
        last_layer = max(one.largest, other.largest) * height if abs(one.top - other.top) == 1 else 0
        return abs(one.volume - other.volume) <= 0.03 * max(one.volume, other.volume) + 40 * cell * height + last_layer

    def unmatched(self, regions, others, pixel, height):
        least = 60 * pixel ** 2 * height
        return [r for r in regions if r.volume > least and not any(self.same(r, o, pixel, height) for o in others)]

    def test_regions_are_those_of_the_search(self):
        found = 0
        for name, count, rows in PUBLIC:
            with self.subTest(name):
                mesh = MESHES / name
                (_, _, low), (_, _, high) = self.run_program("info", mesh, "--json").json()["bbox"]
                height = float(f"{(high - low) / count:.3g}")
                self.succeed("slice", mesh, "--layer-height", height, "-o", "layers.json", "-q")
                searches, pixel = self.searches("layers.json", rows)
                result = self.check(mesh, "--layer-height", height, "--threads", 1)
                again = self.check("layers.json", "--threads", 3)
                self.assertEqual(*({**r, "path": None} for r in (again, result)), f"{name}: its layers differ from it")
                found += result["islands"] + result["cups"] + result["traps"]
                for kind in ("islands", "cavities"):
                    regions = [self.region_of(r, height) for r in result[f"list_of_{kind}"]]
                    along_x, along_y = (getattr(search, kind) for search in searches)
                    certain = [r for r in along_x if any(self.same(r, o, pixel, height) for o in along_y)]
                    for title, missing in (("not found", self.unmatched(certain, regions, pixel, height)),
                                           ("invented", self.unmatched(regions, along_x + along_y, pixel, height))):
                        self.assertEqual([vars(r) for r in missing], [], f"{name}: {kind} {title}")
        self.assertGreater(found, 100)


if __name__ == "__main__":
    main()
