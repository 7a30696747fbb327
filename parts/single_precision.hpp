#pragma once

// Rounding to the single precision of STL files, and its resolution.

#include "lamella/core/point.hpp"
#include "lamella/mesh/triangle_soup.hpp"

namespace lamella {

[[nodiscard]] inline Point3f single(const Point3& p) noexcept {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Returns true if corners `step` apart remain distinct in single precision on a body that extends up to
/// `extent` from the origin, with a margin for slanted steps.
[[nodiscard]] inline bool resolvable(double step, double extent) noexcept {
    return step > extent * 0x1p-20 && extent < 1e30 && step > 1e-30;
}

} // namespace lamella
