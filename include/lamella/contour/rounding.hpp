#pragma once

// Rounding of numbers in slice formats.

#include "lamella/contour/layer.hpp"

#include <algorithm>
#include <cmath>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// Rounding of coordinates and heights by a format; none by default.
struct Rounding {
    double step_mm = 0;            ///< numbers are rounded to multiples of this; 0: not rounded
    bool single_precision = false; ///< numbers are rounded to 24 significant bits

    /// Returns the largest distance between neighbouring numbers of the format, up to this magnitude.
    /// Rounding moves no number by more than half of this distance.
    [[nodiscard]] double step_at(double magnitude_mm) const noexcept {
        constexpr double last_digit = 0x1p-23;
        return std::max(step_mm, single_precision ? std::abs(magnitude_mm) * last_digit : 0.0);
    }
    friend bool operator==(const Rounding&, const Rounding&) = default;
};

/// Returns the largest distance by which rounding may have moved the plane of a layer. This includes formats
/// that store only bottom and top, from which the plane is computed.
[[nodiscard]] inline double moved_cut(const Layer& layer, const Rounding& rounding) noexcept {
    return rounding.step_at(std::max(std::abs(layer.bottom), std::abs(layer.top))) / 2;
}

/// Returns the largest absolute value of a coordinate; 0 without points. O(points).
[[nodiscard]] inline double largest_coordinate(std::span<const Point2> points) noexcept {
    double largest = 0;
    for (const Point2& p : points)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return largest;
}

/// Returns the largest distance by which a format may have moved a point whose coordinates have at most this
/// absolute value, in mm, including the rounding errors of double precision.
[[nodiscard]] inline double moved_point(double largest_coordinate, const Rounding& rounding) noexcept {
    if (rounding == Rounding{})
        return 0;
    constexpr double last_digits = 0x1p-50;
    return (rounding.step_at(largest_coordinate) / 2 + last_digits * largest_coordinate) * std::sqrt(2.0);
}

/// Returns the same for one of these points. O(points) if the format rounds.
[[nodiscard]] inline double moved_point(std::span<const Point2> points, const Rounding& rounding) noexcept {
    return rounding == Rounding{} ? 0 : moved_point(largest_coordinate(points), rounding);
}

/// The rounding of text formats that define no unit of their own.
inline constexpr Rounding text_rounding{.step_mm = 0.001};

} // namespace lamella
LAMELLA_API_END
