#pragma once

// Checks that scan vectors reach the material.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/scan/strategy.hpp"

#include "jobs/exposure_groups.hpp"

#include <vector>

namespace lamella {

/// Possible sections of the material of a plane. There are several if the format may have moved the cut.
struct MaterialBounds {
    std::vector<Layer> sections; ///< the first is at the height in the file
    double depth = 0;            ///< distance of their outlines from that of the part
};

/// Measures the material of each possible section that no vector reaches, and keeps the smallest result. Adds
/// unreached_layers if it is more than the strategy accepts.
/// Vectors are rounded; the edges of the material may have moved by `moved_edges`.
void check_reach(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 const Rounding& rounding, double moved_edges, const LayerLimits& limits, Findings& found);

} // namespace lamella
