#pragma once

// Reduces the number of points of contours.

#include "lamella/contour/layer.hpp"

LAMELLA_API_BEGIN
namespace lamella {

/// Removes points such that no point of a contour, old or new, is farther than `tolerance` mm from the other
/// one (Hausdorff distance). The remaining points keep their coordinates and their order; ends of chains
/// remain.
///
/// Contours that do not cross do not begin to: where the removal of points would make contours cross, or
/// would invert a ring, let it vanish or move it past another ring, points are restored until it does not,
/// all of them if necessary. A tolerance of 0 removes exactly collinear points.
///
/// Follows Douglas and Peucker: the farthest points are kept first. Where these repeatedly split off little,
/// as along spikes and spirals, middle points are kept instead, so that it takes O(n log n). Points are
/// restored in passes, usually few, each of which searches for crossings again. Throws Error{usage} for a
/// tolerance that is negative or NaN.
[[nodiscard]] Layer simplify(const Layer& layer, double tolerance);

/// Does the same for each contour independently, which is much faster, for display. No ring vanishes or is
/// inverted, but contours closer to one another than twice the tolerance may come to cross. Contours keep
/// their order and their first points, so it also suits scan vectors.
[[nodiscard]] Layer simplify_each(const Layer& layer, double tolerance);

} // namespace lamella
LAMELLA_API_END
