#pragma once

// The single precision of STL files: rounding to it, and what it can tell apart.

#include "lamella/core/point.hpp"
#include "lamella/mesh/triangle_soup.hpp"

namespace lamella {

[[nodiscard]] inline Point3f single(const Point3& p) noexcept {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Corners `step` apart stay apart when rounded to single precision on a body that reaches as far as
/// `extent` from the origin, with room for slanted steps.
[[nodiscard]] inline bool resolvable(double step, double extent) noexcept {
    return step > extent * 0x1p-20 && extent < 1e30 && step > 1e-30;
}

} // namespace lamella
