#pragma once

#include "lamella/core/point.hpp"

#include <cmath>

namespace lamella {

/// What lies further away could make sums and areas overflow; no part is near it. In millimetres, or in the
/// unit of a mesh.
inline constexpr double farthest_mm = 1e100;

/// So is what is no number.
[[nodiscard]] inline bool is_too_far(double length) noexcept {
    return !(std::abs(length) <= farthest_mm);
}
[[nodiscard]] inline bool is_too_far(const Point3& p) noexcept {
    return is_too_far(p.x) || is_too_far(p.y) || is_too_far(p.z);
}

} // namespace lamella
