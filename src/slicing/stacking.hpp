#pragma once

// Helpers of all plans that stack layers.

#include "lamella/core/error.hpp"
#include "lamella/slicing/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella {

// A part of a layer below this fraction of its height is rounding noise of the file, not material.
inline constexpr double negligible = 1e-3;

/// Returns the position of the cut within the thickness of a layer, from 0 (bottom) to 1 (top).
[[nodiscard]] constexpr double fraction(SliceAt at) noexcept {
    return at == SliceAt::bottom ? 0.0 : at == SliceAt::top ? 1.0 : 0.5;
}

/// Returns whether a layer of this height, cut at z, meets a part that ends at z_max.
[[nodiscard]] constexpr bool meets_part(double z, double height, double z_max, SliceAt at) noexcept {
    return at == SliceAt::top ? z <= z_max + negligible * height : z < z_max - negligible * height;
}

/// Throws Error{usage} unless `height`, mm, is a positive finite number. The message calls it `what`.
inline void require_height(double height, const char* what) {
    if (!(std::isfinite(height) && height > 0))
        throw Error(ErrorKind::usage, fmt::format("{} is {} mm; it must be a number above 0", what, height));
}

/// Throws Error{usage} unless the ends of a part are finite and z_min < z_max.
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
