"""Bodies and their defects."""

import random
from dataclasses import dataclass, field

from bench.broken.triangles import bounds, box, gem, section_areas, sheet, single, turned

LAYER_HEIGHT_MM = 0.25  # cuts are exact: 0.125, 0.375, ...


@dataclass
class Case:
    name: str
    title: str
    broken: str  # the defect, for the report
    triangles: list
    policies: tuple  # suitable options of `lamella slice`
    # The intended solid, as a sum of closed meshes that are added (1) or subtracted (-1).
    solid: list = field(default_factory=list)

    def planes(self):
        """Returns the heights of the cuts: the middles of full layers, and of a last layer that is more than half
        full."""
        low, high = bounds(self.triangles)
        count = int((high[2] - low[2]) / LAYER_HEIGHT_MM + 0.5)
        return [low[2] + (i + 0.5) * LAYER_HEIGHT_MM for i in range(count)]

    def true_areas(self):
        planes = self.planes()
        parts = [[sign * area for area in section_areas(mesh, planes)] for sign, mesh in self.solid]
        return [sum(areas) for areas in zip(*parts)]


def cases(ring):
    """Returns all cases. `ring` is an oblique torus of some thousand triangles, about 24 mm wide."""
    block, beside = box((0, 0, 0), (20, 20, 20)), box((24, 0, 0), (36, 20, 20))
    shifted, shared = box((10, 8, 0), (30, 28, 20)), box((10, 8, 0), (20, 20, 20))
    lump, within = box((5, 5, 5), (15, 15, 15)), box((20, 20, 0), (40, 40, 20))
    wall = sheet((10, 0, 0), (10, 20, 0), (10, 20, 20), (10, 0, 20))
    fin = sheet((20, 10, 0), (32, 10, 0), (32, 10, 20), (20, 10, 20))
    gems = [gem(0, 0, 20.25), gem(20.25, 0, 20.25)]
    whole_ring, whole_block = [(1, ring)], [(1, block)]
    everything = flipped(repeated(torn(split(knocked(ring, 2.0), 0.1), 0.002), 0.05), 0.05)
    return [
        Case("sound", "a sound ring", "none", ring, (), whole_ring),
        Case("hole", "a hole", "a patch of triangles, 5 mm wide, is missing", knocked(ring, 2.5),
             ("--close-gaps", "8"), whole_ring),
        Case("missing", "missing triangles", "one triangle in fifty is missing", thinned(ring, 0.02),
             ("--close-gaps", "3"), whole_ring),
        Case("flipped", "flipped triangles", "one triangle in ten is flipped", flipped(ring, 0.1), ("--orient",), whole_ring),
        Case("repeated", "duplicate triangles", "one triangle in ten is stored twice", repeated(ring, 0.1),
             ("--drop-duplicates",), whole_ring),
        Case("split", "T-junctions", "one triangle in five is split at the middle of an edge, its neighbour is not",
             split(ring, 0.2), ("--close-gaps", "0.01"), whole_ring),
        Case("torn", "unwelded vertices", "every corner of every triangle is moved by up to 0.005 mm along each axis", torn(ring, 0.005),
             ("--weld-tolerance", "0.02"), whole_ring),
        Case("several", "several defects at once", "a hole, T-junctions, unwelded vertices, duplicate and flipped triangles",
             everything,
             ("--weld-tolerance", "0.01", "--drop-duplicates", "--orient", "--close-gaps", "6"), whole_ring),
        Case("overlap", "overlapping bodies", "two blocks overlap", block + shifted, ("--fill", "nonzero"),
             [(1, block), (1, shifted), (-1, shared)]),
        Case("twice", "a duplicated body", "all triangles are stored twice", block + block, ("--fill", "nonzero"), whole_block),
        Case("within", "a body within a body", "a block within a block, both counter-clockwise from outside", block + lump,
             ("--fill", "nonzero"), whole_block),
        Case("inside-out", "an inverted body", "the second of two blocks is inverted", block + list(map(turned, beside)),
             ("--orient",), [(1, block), (1, beside)]),
        Case("wall", "an internal face, stored once", "a wall through the middle of a block, of two triangles", block + wall, (),
             whole_block),
        Case("double-wall", "an internal face, stored twice", "the same wall twice, with opposite orientations",
             block + wall + list(map(turned, wall)), ("--fill", "nonzero"), whole_block),
        Case("fin", "a wall without thickness", "a fin on a block: two triangles and their flipped copies",
             block + fin + list(map(turned, fin)), (), whole_block),
        Case("edge", "an edge of four triangles", "two blocks that touch along an edge", block + within, (),
             [(1, block), (1, within)]),
        Case("point", "bodies that touch at a point", "two bodies with one vertex in common, which a plane passes through",
             gems[0] + gems[1], (), [(1, one) for one in gems]),
    ]


def chooser(share):
    """Returns a reproducible random choice."""
    numbers = random.Random(1)
    return lambda: numbers.random() < share


def knocked(triangles, radius):
    """Returns the triangles without those near the corner that is farthest along x."""
    x, y, z = max(corner for triangle in triangles for corner in triangle)

    def far(triangle):
        middle = [sum(column) / 3 for column in zip(*triangle)]
        return (middle[0] - x)**2 + (middle[1] - y)**2 + (middle[2] - z)**2 > radius**2

    return list(filter(far, triangles))


def thinned(triangles, share):
    chosen = chooser(share)
    return [triangle for triangle in triangles if not chosen()]


def flipped(triangles, share):
    chosen = chooser(share)
    return [turned(triangle) if chosen() else triangle for triangle in triangles]


def repeated(triangles, share):
    chosen = chooser(share)
    return triangles + [triangle for triangle in triangles if chosen()]


def split(triangles, share):
    chosen = chooser(share)
    found = []
    for a, b, c in triangles:
        if chosen():
            middle = single(tuple((p + q) / 2 for p, q in zip(a, b)))
            found += [(a, middle, c), (middle, b, c)]
        else:
            found.append((a, b, c))
    return found


def torn(triangles, most):
    numbers = random.Random(2)

    def moved(corner):
        return single(tuple(value + numbers.uniform(-most, most) for value in corner))

    return [tuple(map(moved, triangle)) for triangle in triangles]
