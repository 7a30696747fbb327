"""Meshes as lists of triangles: a triangle is three corners, a corner three numbers of single precision."""

import struct
from pathlib import Path

RECORD = struct.Struct("<12fH")
CORNER = struct.Struct("<3f")


def read_stl(path):
    """Reads a binary file."""
    data = Path(path).read_bytes()
    return [(row[3:6], row[6:9], row[9:12]) for row in RECORD.iter_unpack(data[84:])]


def write_stl(path, triangles):
    header = b"binary STL".ljust(80) + struct.pack("<I", len(triangles))
    Path(path).write_bytes(header + b"".join(RECORD.pack(0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles))


def single(corner):
    """Rounds to single precision, as in a file."""
    return CORNER.unpack(CORNER.pack(*corner))


def box(low, high):
    """Returns twelve triangles, counter-clockwise as seen from outside."""
    corners = [tuple((low, high)[bits >> axis & 1][axis] for axis in range(3)) for bits in range(8)]
    squares = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [triangle for square in squares for triangle in sheet(*(corners[i] for i in square))]


def gem(x, y, height):
    """Returns a body with a square base and a tip, widest half-way up, with corners at x +- height/2 and y +-
    height/2."""
    def square(z, radius):
        return [(x + radius * dx, y + radius * dy, z) for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1))]

    foot, girdle, tip = square(0, height / 4), square(height / 2, height / 2), (x, y, height)
    found = [turned(triangle) for triangle in sheet(*foot)]
    for i in range(4):
        j = (i + 1) % 4
        found += sheet(foot[i], foot[j], girdle[j], girdle[i])
        found.append((girdle[i], girdle[j], tip))
    return found


def sheet(a, b, c, d):
    """Returns a flat square of two triangles."""
    return [(a, b, c), (a, c, d)]


def turned(triangle):
    a, b, c = triangle
    return (a, c, b)


def bounds(triangles):
    columns = list(zip(*(corner for triangle in triangles for corner in triangle)))
    return tuple(map(min, columns)), tuple(map(max, columns))


def section_areas(triangles, planes):
    """Returns the areas of the sections just above each of the ascending planes, computed from single triangles without
    linking: every cut triangle adds the area between its segment and the middle of the mesh, with the sign of its
    direction."""
    low, high = bounds(triangles)
    middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2)
    areas = []
    remaining = sorted(triangles, key=lambda triangle: min(corner[2] for corner in triangle), reverse=True)
    active = []
    for z in planes:
        while remaining and min(corner[2] for corner in remaining[-1]) <= z:
            active.append(remaining.pop())
        active = [triangle for triangle in active if max(corner[2] for corner in triangle) > z]
        areas.append(sum(sector(triangle, z, middle) for triangle in active))
    return areas


def sector(triangle, z, middle):
    """Returns the area of a cut triangle. Material is to the left of its segment, which runs from the descending edge
    to the ascending one."""
    ends = {}
    for a, b in zip(triangle, triangle[1:] + triangle[:1]):
        if (a[2] > z) != (b[2] > z):
            share = (z - a[2]) / (b[2] - a[2])
            ends[a[2] > z] = tuple(a[i] + share * (b[i] - a[i]) - middle[i] for i in range(2))
    (ax, ay), (bx, by) = ends[True], ends[False]
    return (ax * by - ay * bx) / 2
