#pragma once

// Checks that scan vectors reach the material.

#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/strategy.hpp"

#include "pipeline/exposure_groups.hpp"
#include "pipeline/vector_findings.hpp"

namespace lamella {

/// Measures the material of each possible section that no vector reaches, and keeps the smallest result.
/// Vectors are rounded; the edges of the material may have moved by `moved_edges`.
void check_reach(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 const Rounding& rounding, double moved_edges, const LayerLimits& limits,
                 PlaneFindings& found);

} // namespace lamella
