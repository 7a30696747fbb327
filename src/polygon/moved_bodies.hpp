#pragma once

// The material of moved rings that cross too often to be united all at once.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/polygon/nesting.hpp"

#include <span>

namespace lamella {

/// Returns the boundary, without walls, of the points with a winding number above 0 of all moved rings, like
/// their union at once. `bodies` are those of the rings before they were moved by `distance`. Bodies are
/// united by divide and conquer, so that the crossings within a half are gone before both halves meet. Throws
/// Error{limit} and Error{cancelled}. O((n + k) log^2 n) for n points and k corners of the result, if unions
/// of moved bodies cross no more often than those of pseudo-discs; see the source.
[[nodiscard]] Layer united_by_halves(const Layer& moved, std::span<const Polygon> bodies, double distance,
                                     const LayerLimits& limits);

} // namespace lamella
