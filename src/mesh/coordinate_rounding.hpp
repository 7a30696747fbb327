#pragma once

#include "lamella/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

/// How far a vertex of a mesh in this box may be from where it is meant to be, by rounding alone. Coordinates
/// of files are most often of single precision: 2^-21 of the largest one is four units in the last place, as
/// much as a rotation makes of the half units of three coordinates; and 1e-6 mm at least, the last digit of
/// many text files.
[[nodiscard]] inline double coordinate_rounding(const Box3& box) noexcept {
    double largest = 0;
    for (const double length : {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z})
        largest = std::max(largest, std::abs(length));
    constexpr double least = 1e-6;
    return std::max(least, 0x1p-21 * largest);
}

} // namespace lamella
