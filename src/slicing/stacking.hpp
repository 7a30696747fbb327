#pragma once

// What all plans that stack layers on one another have in common.

#include "lamella/slicing/plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lamella {

inline constexpr std::uint64_t max_layers = (std::uint64_t{1} << 31) - 2; // ranks are 31-bit numbers

// What is left of a layer below this share of its height is rounding noise of the file, not material.
inline constexpr double negligible = 1e-3;

/// Where in its thickness a layer is cut, from 0 (bottom) to 1 (top).
[[nodiscard]] constexpr double fraction(SliceAt at) noexcept {
    return at == SliceAt::bottom ? 0.0 : at == SliceAt::top ? 1.0 : 0.5;
}

/// Whether planes are in strictly ascending z, all of them finite, as in every plan.
[[nodiscard]] inline bool is_ascending(const Plan& plan) noexcept {
    const auto out_of_order = [](const PlannedLayer& a, const PlannedLayer& b) {
        return !(a.z < b.z);
    };
    const std::vector<PlannedLayer>& layers = plan.layers;
    return std::adjacent_find(layers.begin(), layers.end(), out_of_order) == layers.end() &&
           (layers.empty() || (std::isfinite(layers.front().z) && std::isfinite(layers.back().z)));
}

[[nodiscard]] constexpr PlaneRule rule_for(SliceAt at) noexcept {
    return at == SliceAt::top ? PlaneRule::section_below : PlaneRule::section_above;
}

} // namespace lamella
