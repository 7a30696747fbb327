#pragma once

// How slice formats round numbers.

#include "lamella/contour/layer.hpp"

#include <algorithm>
#include <cmath>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// How a format rounds coordinates and heights. By default it does not.
struct Rounding {
    double step_mm = 0;            ///< to multiples of this; 0: to none
    bool single_precision = false; ///< to 24 significant bits

    /// The largest distance of neighbouring numbers that the format can tell apart, up to this magnitude: no
    /// number is moved by more than half of it.
    [[nodiscard]] double step_at(double magnitude_mm) const noexcept {
        constexpr double last_place = 0x1p-23;
        return std::max(step_mm, single_precision ? std::abs(magnitude_mm) * last_place : 0.0);
    }
    friend bool operator==(const Rounding&, const Rounding&) = default;
};

/// How far a format may have moved the cut of a layer. Where it keeps bottom and top only, the cut was
/// computed from these.
[[nodiscard]] inline double moved_cut(const Layer& layer, const Rounding& rounding) noexcept {
    return rounding.step_at(std::max(std::abs(layer.bottom), std::abs(layer.top))) / 2;
}

/// Of any of these points; 0 for none. O(points).
[[nodiscard]] inline double largest_coordinate(std::span<const Point2> points) noexcept {
    double largest = 0;
    for (const Point2& p : points)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return largest;
}

/// How far a format may have moved one of these points, in mm, and what the last digits of numbers in memory
/// add to that. O(points), where it rounds.
[[nodiscard]] inline double moved_point(std::span<const Point2> points, const Rounding& rounding) noexcept {
    if (rounding == Rounding{})
        return 0;
    const double largest = largest_coordinate(points);
    constexpr double last_digits = 0x1p-50;
    return (rounding.step_at(largest) / 2 + last_digits * largest) * std::sqrt(2.0);
}

/// What text formats round to that have no unit of their own.
inline constexpr Rounding text_rounding{.step_mm = 0.001};

} // namespace lamella
LAMELLA_API_END
