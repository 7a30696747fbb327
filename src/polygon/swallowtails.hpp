#pragma once

// Small loops cut out of moved rings.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella {

/// A point of a moved ring, and the number of the corner that it comes from.
struct MovedPoint {
    Point2 at;
    std::size_t corner;
};

/// Puts a moved ring, its points in the order of its corners, without loops where nothing is lost by it.
/// `distance`: by how much sides were moved to the right. What goes from the last point to the first one is
/// not looked at. O(points).
void add_without_swallowtails(std::span<const MovedPoint> ring, std::span<const Point2> corners,
                              double distance, std::vector<Point2>& out);

} // namespace lamella
