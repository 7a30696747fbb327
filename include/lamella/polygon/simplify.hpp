#pragma once

// Fewer points for the same contours.

#include "lamella/contour/layer.hpp"

LAMELLA_API_BEGIN
namespace lamella {

/// The layer with some of its points left out, so that no point of a contour, old or new, is farther than
/// `tolerance` mm from the other one (Hausdorff distance). Points that remain keep their coordinates and
/// their order; ends of chains remain.
///
/// Contours that do not cross do not begin to: where leaving out points would make contours cross, turn a
/// ring over, let it vanish or move it past another one, points are put back there until it does not, if need
/// be all of them. A tolerance of 0 leaves out points that lie exactly on a line with their neighbours.
///
/// By the method of Douglas and Peucker: the farthest points are kept first. Where these split off little
/// time and again, as along spikes and spirals, middle points take their place, so that it takes O(n log n).
/// Points are put back in rounds, each of which looks for crossings once more: few, as a rule. Throws
/// Error{usage} for a tolerance that is negative or not a number.
[[nodiscard]] Layer simplify(const Layer& layer, double tolerance);

/// The same for each contour by itself, for pictures: in a small part of the time. No ring vanishes or turns
/// over, but contours that are closer to one another than twice the tolerance may come to cross. Contours
/// keep their order and their first points, so it is for scan vectors, too.
[[nodiscard]] Layer simplify_each(const Layer& layer, double tolerance);

} // namespace lamella
LAMELLA_API_END
