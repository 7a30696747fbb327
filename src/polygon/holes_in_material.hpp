#pragma once

// A quick look at a layer: does each clockwise ring lie in material?

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"

namespace lamella {

/// Whether the winding number just left of the left end of each clockwise ring is known to be at least 1:
/// then a layer in normal form whose rings do not cross has no winding number below 0. False, too, where that
/// cannot be told quickly: where a left end lies on another ring, where a ring does not show its direction
/// there, where the ring's box reaches out of those of the rings around it, and where many rings lie over one
/// another. Rings so thin that `rounding` may have turned them over need not lie in material.
[[nodiscard]] bool holes_lie_in_material(const Layer& layer, const Rounding& rounding);

} // namespace lamella
