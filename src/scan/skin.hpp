#pragma once

// Finds areas of a layer with too little material above or below.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"

#include <span>

namespace lamella {

/// The area of a layer with less than `rule.layers` layers of material above or below it.
class Skin {
  public:
    /// `neighbours` are the layers above or below, from the nearest one on. If there are fewer than the rule
    /// requires, the part ends there. It also ends at a gap in height before a neighbour.
    Skin(const ScanLayer& layer, std::span<const ScanLayer> neighbours, const SkinRule& rule,
         const LayerLimits& limits = {});

    /// Returns whether the entire layer is skin, because the part ends there.
    [[nodiscard]] bool whole() const noexcept { return whole_; }
    /// Returns the skin as rings that do not cross. It may reach beyond the layer. Requires that `whole` is
    /// false.
    [[nodiscard]] const Layer& area() const noexcept { return area_; }
    /// Returns the skin and the area closer to it than the overlap.
    [[nodiscard]] const Layer& with_overlap() const noexcept { return with_overlap_; }

  private:
    bool whole_ = false;
    Layer area_;
    Layer with_overlap_;
};

} // namespace lamella
