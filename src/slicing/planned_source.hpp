#pragma once

// A plane source for the planes of a plan.

#include "lamella/contour/plane_source.hpp"
#include "lamella/slicing/plan.hpp"

namespace lamella {

/// Returns a source with the planes of the plan and its rule, which still has no parts.
[[nodiscard]] inline PlaneSource planned_source(const Plan& plan) {
    PlaneSource source;
    source.rule = plan.rule;
    source.planes.reserve(plan.layers.size());
    for (const PlannedLayer& layer : plan.layers)
        source.planes.push_back(
            {.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top});
    return source;
}

} // namespace lamella
