#pragma once

// Overlaps between the parts of a plate, in which material would be exposed twice.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The layers of all parts on a plane. Parts that overlap are one part: the first of them has the material of
/// all, and the others are empty.
struct UnitedParts {
    std::vector<Layer> parts;
    /// Area of the overlaps of each part with the parts before it that stay separate, mm^2.
    std::vector<double> overlaps_mm2;
    std::vector<bool> changed; ///< true for each part that was united with others
};

/// Unites overlapping parts with equal numbers in `objects`. Parts whose `supports` differ are neither united
/// nor do their overlaps count, because supports reach into parts on purpose. Parts that only touch stay as
/// they are. `names` are those of the parts for error messages, or empty. O(n log n) for n parts, and what
/// combining takes for each pair whose boxes overlap.
[[nodiscard]] UnitedParts unite_overlapping_parts(std::span<const Layer> parts,
                                                  std::span<const std::uint32_t> objects,
                                                  const std::vector<bool>& supports,
                                                  const LayerLimits& limits = {},
                                                  std::span<const std::string> names = {});

} // namespace lamella
