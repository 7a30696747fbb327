"""Least-squares fits: power laws on logarithms, and straight lines."""

import math


def power_law(points):
    """Returns (factor, exponent) of y = factor * x ** exponent through points with positive coordinates, or None."""
    usable = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    line = straight_line(usable)
    return None if line is None else (math.exp(line[0]), line[1])


def straight_line(points):
    """Returns (intercept, slope), or None if all x are equal."""
    if not points:
        return None
    mean_x, mean_y = (sum(values) / len(points) for values in zip(*points))
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    if spread == 0:
        return None
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / spread
    return mean_y - slope * mean_x, slope
