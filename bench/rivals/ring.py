"""Area and length of a ring of points."""

import math


def signed_area(ring):
    """Returns a positive area if the ring runs counter-clockwise. Computes relative to the first point, so that a small
    ring far from the origin is precise."""
    x0, y0 = ring[0]
    return sum((ax - x0) * (by - y0) - (bx - x0) * (ay - y0)
               for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1])) / 2


def length(ring):
    return sum(math.dist(a, b) for a, b in zip(ring, ring[1:] + ring[:1]))
