#pragma once

// Checks that scan vectors fill the material.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/scan/strategy.hpp"

#include "pipeline/exposure_groups.hpp"
#include "pipeline/vector_findings.hpp"

namespace lamella {

/// Returns the material at this distance from its edges. Overlapping bodies are united even if the depth is
/// 0, as in `scan`.
[[nodiscard]] Layer moved_inwards(const Layer& section, double depth, const LayerLimits& limits,
                                  const OffsetCorners& corners = {});

/// Compares the area that hatch lines cover with the area that they must fill. `tolerance` is that of edges
/// of the material.
void check_cover(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 double tolerance, const LayerLimits& limits, PlaneFindings& found);

/// Measures the material of each possible section that no vector reaches, and keeps the smallest result.
/// Vectors are rounded; the edges of the material may have moved by `moved_edges`.
void check_reach(const PlaneGroup& group, const MaterialBounds& bounds, const ScanStrategy& strategy,
                 const Rounding& rounding, double moved_edges, const LayerLimits& limits,
                 PlaneFindings& found);

} // namespace lamella
