#pragma once

// A quick test that each clockwise ring of a layer lies in material.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"

namespace lamella {

/// Returns whether the winding number just left of the left end of each clockwise ring is known to be at
/// least 1. A layer in normal form whose rings do not cross then has no winding number below 0. Also returns
/// false if this cannot be decided quickly: if a left end lies on another ring, if the corner at the left end
/// does not show the direction of the ring, if the box of a ring is not within those of the rings around it,
/// or if many rings are nested or above one another. Rings so thin that `rounding` may have inverted them
/// need not lie in material.
[[nodiscard]] bool holes_lie_in_material(const Layer& layer, const Rounding& rounding);

} // namespace lamella
