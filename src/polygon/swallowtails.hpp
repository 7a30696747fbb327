#pragma once

// Removes small loops (swallowtails) from moved rings.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella {

/// A point of a moved ring, and the index of its corner.
struct MovedPoint {
    Point2 at;
    std::size_t corner;
};

/// Appends a moved ring, whose points are in the order of its corners, without those loops that can be cut
/// off without changing the material. `distance` is the distance by which sides were moved to the right. The
/// segment from the last point to the first is not examined. O(points).
void add_without_swallowtails(std::span<const MovedPoint> ring, std::span<const Point2> corners,
                              double distance, std::vector<Point2>& out);

} // namespace lamella
