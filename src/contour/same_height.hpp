#pragma once

#include "lamella/contour/layer.hpp"

#include <cmath>

namespace lamella {

/// Heights that differ by at most this count as equal, mm. Heights that should be equal may differ in their
/// last digits, because they are multiples or sums of decimal fractions.
inline constexpr double same_height_mm = 1e-6;

/// Returns whether two layers have the same index and heights.
[[nodiscard]] inline bool on_same_plane(const Layer& a, const Layer& b) noexcept {
    const auto same = [](double first, double second) {
        return std::abs(first - second) <= same_height_mm;
    };
    return a.index == b.index && same(a.z, b.z) && same(a.bottom, b.bottom) && same(a.top, b.top);
}

} // namespace lamella
