#pragma once

// Where a layer has too little material above it, or below it.

#include "lamella/contour/layer.hpp"
#include "lamella/scan/strategy.hpp"

#include <span>

namespace lamella {

/// Where a layer has less than `rule.layers` layers of material beside it.
class Skin {
  public:
    /// `neighbours`: from the nearest one on, as many as there are; fewer than the rule asks for where the
    /// part ends.
    Skin(const Layer& layer, std::span<const Layer> neighbours, const SkinRule& rule);

    /// What of an area within the layer, whose rings do not cross, is within the skin or closer to it than
    /// the overlap.
    [[nodiscard]] Layer of(const Layer& area) const;
    /// What of it is not within the skin.
    [[nodiscard]] Layer rest_of(const Layer& area) const;

  private:
    bool whole_ = false; ///< all of the layer is skin
    Layer skin_;
    Layer with_overlap_;
};

} // namespace lamella
