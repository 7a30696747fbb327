#pragma once

// Compensation for the width of a beam or for what a pixel bleeds: contours moved outwards or inwards.

#include "lamella/contour/layer.hpp"

#include <cstdint>

namespace LAMELLA_API lamella {

/// The layer with its material grown by `distance` mm on all sides, or shrunk by a negative one: outer rings
/// move outwards, holes get smaller, and what meets is united, as material where the winding number is above
/// 0.
///
/// Sides are moved in parallel and meet again in corners, so that parts keep their corners and contours their
/// number of points. A corner that would move by more than twice the distance (sharper than 60 degrees) is
/// cut off at right angles to its bisector. Points are off by at most about 2^-35 of the layer's extent.
///
/// Open chains stay as they are. A distance of 0 gives the layer itself, bit for bit. Costs what the clipping
/// library takes, some microseconds a point. `vanished`, where given, becomes the number of rings that
/// nothing is left of: those of bodies that are too thin to be shrunk so far, and holes that growing closes.
/// Throws Error{usage} for a distance that is not finite.
[[nodiscard]] Layer offset(const Layer& layer, double distance, std::uint64_t* vanished = nullptr);

} // namespace lamella
