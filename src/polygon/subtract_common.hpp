#pragma once

// Subtracts from a layer the intersection of several others.

#include "lamella/contour/layer.hpp"

#include <span>

namespace lamella {

/// Returns the layer minus the intersection of the others. Requires at least one other layer. Each of the
/// others must have winding numbers 0 or 1, as the results of `fill` have. Works like `combine`, but on all
/// layers at once.
[[nodiscard]] Layer subtract_common(const Layer& layer, std::span<const Layer> others,
                                    const LayerLimits& limits = {});

} // namespace lamella
