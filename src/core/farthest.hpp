#pragma once

#include "lamella/core/point.hpp"

#include <cmath>

namespace lamella {

/// Largest allowed absolute coordinate, in millimetres or in the unit of a mesh. Beyond it sums and areas
/// could overflow. Real parts are far smaller.
inline constexpr double farthest_mm = 1e100;

/// Returns true if the length is beyond `farthest_mm` or is NaN.
[[nodiscard]] inline bool is_too_far(double length) noexcept {
    return !(std::abs(length) <= farthest_mm);
}
[[nodiscard]] inline bool is_too_far(const Point3& p) noexcept {
    return is_too_far(p.x) || is_too_far(p.y) || is_too_far(p.z);
}

} // namespace lamella
