"""Cuts a mesh with NumPy alone, by two methods.

usage: numpy_slicer.py planes|bulk MESH HEIGHTS RESULT

`planes` processes all triangles for each plane, like trimesh's mesh_multiplane, with the heights of vertices computed
once. `bulk` makes all segments of all planes at once and visits a triangle only as often as it is cut: the best that
arrays can do. Both then join segments to rings: segments are found by the edge on which they begin, and followed from
list to list. RESULT is JSON as the other slicers write it, and includes the areas of layers.
"""

import json
import sys
import time

import numpy as np

STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read(path):
    """Returns vertices (n, 3) and faces (m, 3) of a binary STL file, equal corners joined."""
    corners = np.fromfile(path, STL, offset=84)["corners"].reshape(-1, 3)
    rows = np.ascontiguousarray(corners).view("V12").ravel()
    _, first, number = np.unique(rows, return_index=True, return_inverse=True)
    return corners[first].astype(float), number.reshape(-1, 3)


def by_planes(vertices, faces, planes):
    """Returns the ends of segments, and the edges on which they begin and end, plane by plane."""
    heights = vertices[:, 2]
    for z in planes:
        above = heights[faces] > z
        count = above.sum(axis=1)
        cut = (count > 0) & (count < 3)
        yield segments(vertices, faces[cut], above[cut], np.full(cut.sum(), z))


def in_bulk(vertices, faces, planes):
    """Returns the same from all triangles and planes at once."""
    rank = np.searchsorted(planes, vertices[:, 2], side="left")[faces]  # number of planes below a vertex
    first, last = rank.min(axis=1), rank.max(axis=1)
    times = last - first
    triangle = np.repeat(np.arange(len(faces)), times)
    begin = np.cumsum(times) - times
    plane = np.arange(times.sum()) - np.repeat(begin - first, times)
    order = np.argsort(plane, kind="stable")
    triangle, plane = triangle[order], plane[order]
    starts, ends, from_edge, to_edge = segments(vertices, faces[triangle], rank[triangle] > plane[:, None], planes[plane])
    bounds = np.searchsorted(plane, np.arange(len(planes) + 1))
    for a, b in zip(bounds[:-1], bounds[1:]):
        yield starts[a:b], ends[a:b], from_edge[a:b], to_edge[a:b]


def segments(vertices, faces, above, z):
    """Returns segments of triangles cut by planes at z. Material is to the left of each segment."""
    lone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), above.argmin(axis=1))
    row = np.arange(len(faces))
    alone, after, before = (faces[row, (lone + step) % 3] for step in (0, 1, 2))
    upward = above[row, lone]  # the single corner is the upper one
    near, far = np.where(upward, after, before), np.where(upward, before, after)
    # Around a triangle with its tip above, seen from outside, the boundary descends through the plane after the tip.
    return (crossing(vertices, alone, near, z), crossing(vertices, alone, far, z),
            edge(alone, near, len(vertices)), edge(alone, far, len(vertices)))


def edge(a, b, count):
    return np.minimum(a, b) * count + np.maximum(a, b)


def crossing(vertices, a, b, z):
    low, high = np.where(vertices[a, 2] < vertices[b, 2], (a, b), (b, a))
    p, q = vertices[low], vertices[high]
    t = (z - p[:, 2]) / (q[:, 2] - p[:, 2])
    return p[:, :2] + t[:, None] * (q[:, :2] - p[:, :2])


def rings(starts, from_edge, to_edge):
    """Returns the points of each ring: a segment is followed by the one that begins on the edge where it ends."""
    order = np.argsort(from_edge)
    following = order[np.searchsorted(from_edge, to_edge, sorter=order)].tolist()
    seen = bytearray(len(following))
    found = []
    for start in range(len(following)):
        if seen[start]:
            continue
        ring, at = [], start
        while not seen[at]:
            seen[at] = 1
            ring.append(at)
            at = following[at]
        found.append(starts[ring])
    return found


def area_and_length(ring):
    x, y = (ring - ring[0]).T
    ends = np.roll(ring, -1, axis=0) - ring
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2, np.hypot(*ends.T).sum()


def main(way, mesh, heights, result):
    planes = np.loadtxt(heights, ndmin=1)
    started = time.perf_counter()
    vertices, faces = read(mesh)
    was_read = time.perf_counter()
    layers = [rings(starts, from_edge, to_edge)
              for starts, _, from_edge, to_edge in (in_bulk if way == "bulk" else by_planes)(vertices, faces, planes)]
    sliced = time.perf_counter()
    measured = [np.array([area_and_length(ring) for ring in layer]).reshape(-1, 2).sum(axis=0) for layer in layers]
    with open(result, "w", encoding="utf-8") as file:
        json.dump({"seconds": {"read": was_read - started, "slice": sliced - was_read},
                   "layers": [{"z": z, "contours": len(layer), "area_mm2": area, "perimeter_mm": length}
                              for z, layer, (area, length) in zip(planes, layers, measured)]}, file)


if __name__ == "__main__":
    main(*sys.argv[1:])
