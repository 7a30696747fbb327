#pragma once

// A quick test that each clockwise ring of a layer lies in material.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"

namespace lamella {

/// Returns whether the winding number just left of the left end of each clockwise ring is known to be at
/// least 1. A layer in normal form whose rings do not cross then has no winding number below 0. Returns false
/// also where this cannot be decided quickly: if a left end lies on another ring, if the direction of a ring
/// is not apparent there, if the box of a ring exceeds those of the rings around it, and if many rings are
/// nested or stacked. Rings so thin that `rounding` may have inverted them need not lie in material.
[[nodiscard]] bool holes_lie_in_material(const Layer& layer, const Rounding& rounding);

} // namespace lamella
