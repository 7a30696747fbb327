#pragma once

// What a layer has beyond what several others have in common.

#include "lamella/contour/layer.hpp"

#include <span>

namespace lamella {

/// What of the material of a layer some of the others have not, of which there is at least one. None of these
/// winds more than once around a place, nor less than not at all, as layers that `fill` made. Decided as by
/// `combine`, of all of them at once.
[[nodiscard]] Layer subtract_common(const Layer& layer, std::span<const Layer> others,
                                    const LayerLimits& limits = {});

} // namespace lamella
