#pragma once

// Subtracts bodies from a layer.

#include "lamella/contour/layer.hpp"

#include <span>

namespace lamella {

/// Returns the layer minus the material of a body that may be flush with its walls. Works like `combine`, but
/// sides of the layer and of the body that are closer than rounding to the grid can move them, about three
/// units, count as running along each other. Otherwise, a wall and a body in the same plane, rotated and
/// rounded, would leave a film of 1e-16 mm between a hole and the wall on some layers, and a notch on others.
[[nodiscard]] Layer subtract_body(const Layer& layer, const Layer& body, const LayerLimits& limits = {});

/// Returns the layer minus the intersection of the others. Requires at least one other layer. Each of the
/// others must have winding numbers 0 or 1, as the results of `fill` have. Works like `combine`, but on all
/// layers at once.
[[nodiscard]] Layer subtract_common(const Layer& layer, std::span<const Layer> others,
                                    const LayerLimits& limits = {});

} // namespace lamella
