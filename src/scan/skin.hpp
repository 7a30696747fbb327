#pragma once

// Where a layer has too little material above it, or below it.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"

#include <span>

namespace lamella {

/// Where a layer has less than `rule.layers` layers of material beside it.
class Skin {
  public:
    /// `neighbours`: from the nearest one on, above or below, as many as there are; fewer than the rule asks
    /// for where the part ends. It ends, too, where by their heights a neighbour lies apart from the one
    /// before it.
    Skin(const ScanLayer& layer, std::span<const ScanLayer> neighbours, const SkinRule& rule,
         const LayerLimits& limits = {});

    /// Whether all of the layer is skin, because the part ends there.
    [[nodiscard]] bool whole() const noexcept { return whole_; }
    /// Else the skin, as rings that do not cross; it may reach beyond the layer.
    [[nodiscard]] const Layer& area() const noexcept { return area_; }
    /// And what is closer to it than the overlap.
    [[nodiscard]] const Layer& with_overlap() const noexcept { return with_overlap_; }

  private:
    bool whole_ = false;
    Layer area_;
    Layer with_overlap_;
};

} // namespace lamella
