#pragma once

#include "lamella/core/point.hpp"

#include <cmath>

namespace lamella {

[[nodiscard]] inline double distance(const Point2& a, const Point2& b) noexcept {
    return std::hypot(a.x - b.x, a.y - b.y);
}

} // namespace lamella
