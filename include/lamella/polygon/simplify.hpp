#pragma once

// Reduces the number of points of contours.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

LAMELLA_API_BEGIN
namespace lamella {

/// Removes points so that the Hausdorff distance of each contour, before and after, is at most `tolerance`
/// mm. The remaining points keep their coordinates and their order; ends of chains remain.
///
/// The topology is kept: contours that do not cross before do not cross afterwards, and no ring vanishes, is
/// inverted or moves past another ring. Where the removal of points would violate this, points are restored,
/// if necessary all of them. A tolerance of 0 removes exactly collinear points.
///
/// Follows Douglas and Peucker: the farthest points are kept first. If the farthest points repeatedly split a
/// contour very unevenly, as along spikes and spirals, middle points are kept instead. The time is therefore
/// O(n log n). Points are restored in passes, usually few, each of which searches for crossings again. Throws
/// Error{usage} for a tolerance that is negative or NaN. The limits apply to crossings of contours.
[[nodiscard]] Layer simplify(const Layer& layer, double tolerance, const LayerLimits& limits = {});

/// Simplifies each contour independently, which is much faster and serves for display. No ring vanishes or is
/// inverted, but contours closer to one another than twice the tolerance may cross afterwards. Contours keep
/// their order and their first points, so this function also suits scan vectors.
[[nodiscard]] Layer simplify_each(const Layer& layer, double tolerance);

} // namespace lamella
LAMELLA_API_END
