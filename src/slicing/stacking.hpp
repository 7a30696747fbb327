#pragma once

// What all plans that stack layers on one another have in common.

#include "lamella/core/error.hpp"
#include "lamella/slicing/plan.hpp"

#include <fmt/format.h>

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

/// Whether a layer of this height, cut at z, meets a part that ends at z_max.
[[nodiscard]] constexpr bool meets_part(double z, double height, double z_max, SliceAt at) noexcept {
    return at == SliceAt::top ? z <= z_max + negligible * height : z < z_max - negligible * height;
}

/// Fails unless `what`, a height of layers in mm, is a number above 0.
inline void require_height(double height, const char* what) {
    if (!(std::isfinite(height) && height > 0))
        throw Error(ErrorKind::usage, fmt::format("{} is {} mm; it must be a number above 0", what, height));
}

/// Fails where there is nothing between the ends of a part.
inline void require_part(double z_min, double z_max) {
    if (z_min < z_max && !(std::isfinite(z_min) && std::isfinite(z_max)))
        throw Error(
            ErrorKind::usage,
            fmt::format("the part reaches from z = {} to {} mm; both heights must be finite", z_min, z_max));
    if (!(z_min < z_max))
        throw Error(ErrorKind::usage,
                    fmt::format("the mesh has no height (z from {} to {}), so there is nothing to slice; "
                                "another slicing direction may have some",
                                z_min, z_max));
}

[[nodiscard]] constexpr PlaneRule rule_for(SliceAt at) noexcept {
    return at == SliceAt::top ? PlaneRule::section_below : PlaneRule::section_above;
}

} // namespace lamella
