#pragma once

// A quick test that each clockwise ring of a layer lies in material.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"

namespace lamella {

/// Returns whether the winding number just left of the left end of each clockwise ring is known to be at
/// least 1. A layer in normal form whose rings do not cross then has no winding number below 0. Also returns
/// false in these cases, which cannot be decided quickly:
///
/// - A left end lies on another ring.
/// - The corner at the left end does not show the direction of the ring.
/// - The box of a ring is not within the boxes of the rings around it.
/// - Many rings are nested or above one another.
///
/// Rings so thin that `rounding` may have inverted them need not lie in material.
[[nodiscard]] bool holes_lie_in_material(const Layer& layer, const Rounding& rounding);

} // namespace lamella
