#pragma once

// Defects of layers, with the location of the first.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/findings/findings.hpp"

#include <string>

namespace lamella {

struct LayerCheck {
    LayerMeasure measure;
    OpenGaps open_gaps;
    Findings found; ///< open_contours, crossings, misoriented_rings, tangled_rings, overlapping_rings
};

[[nodiscard]] LayerCheck check_layer(const Layer& layer, const Rounding& rounding,
                                     const LayerLimits& limits = {});

/// "layer 12 (z 0.375 mm)"
[[nodiscard]] std::string where(const Layer& layer);

/// "layer 12 (z 0.375 mm) at (1, 2)"
[[nodiscard]] std::string where(const Layer& layer, const Point2& at);

} // namespace lamella
