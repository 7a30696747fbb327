#pragma once

#include "lamella/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

/// Returns the largest error that rounding alone can cause in a vertex of a mesh in this box. Most files have
/// single precision. There 2^-21 of the largest coordinate is four units in the last place, enough for half a
/// unit in each of three coordinates and a rotation. At least 1e-6 mm, the last digit of many text files.
[[nodiscard]] inline double coordinate_rounding(const Box3& box) noexcept {
    double largest = 0;
    for (const double length : {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z})
        largest = std::max(largest, std::abs(length));
    constexpr double least = 1e-6;
    return std::max(least, 0x1p-21 * largest);
}

} // namespace lamella
