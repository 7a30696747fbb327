#pragma once

// The edges of contours in image coordinates.

#include "lamella/core/point.hpp"
#include "lamella/raster/image.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace lamella {

/// Column that stands for all edges to the left of the image, because their distance does not matter.
inline constexpr double left_of_image = -1;

/// Returns the least integer that is not below v, between 0 and `most`. (std::ceil is a function call in code
/// compiled for all processors.)
[[nodiscard]] inline std::uint32_t least_whole(double v, std::uint32_t most) noexcept {
    if (!(v > 0))
        return 0;
    if (v >= most)
        return most;
    const auto whole = static_cast<std::uint32_t>(v);
    return whole + (whole < v ? 1 : 0);
}

/// An edge in image coordinates, from its upper to its lower end for either direction of the ring, so that
/// the common border of two bodies gives the same line for both.
struct ImageEdge {
    Point2 upper;
    Point2 lower;
    double slope = 0;         ///< columns per row; 0 for a horizontal edge
    std::int32_t winding = 0; ///< 1 if the ring runs downwards here, else -1

    /// Makes the edge for a ring that runs from `from` to `to`.
    ImageEdge(const Point2& from, const Point2& to) noexcept {
        const bool down = from.y < to.y;
        upper = down ? from : to;
        lower = down ? to : from;
        winding = down ? 1 : -1;
        if (std::max(from.x, to.x) <= 0)
            upper.x = lower.x = left_of_image;
        if (!level())
            slope = (lower.x - upper.x) / (lower.y - upper.y);
    }
    /// Returns the column at the height v, which must lie between those of the ends.
    [[nodiscard]] double column(double v) const noexcept {
        const auto [low, high] = std::minmax(upper.x, lower.x);
        return std::clamp(upper.x + (v - upper.y) * slope, low, high);
    }
    [[nodiscard]] bool level() const noexcept { return upper.y == lower.y; }
};

/// Returns the image coordinates of a point. A coordinate beyond 2^40 pixels is replaced by 2^40: far
/// outside, but still suitable for arithmetic.
[[nodiscard]] __attribute__((always_inline)) inline Point2 position_in_image(const Point2& p,
                                                                             const PixelGrid& grid) noexcept {
    constexpr double far = 0x1p40;
    const auto near = [](double c) __attribute__((always_inline)) { // returns a number even after overflow
        return c < far ? (c > -far ? c : -far) : far;
    };
    return {near(grid.ux * p.x + grid.uy * p.y + grid.u0), near(grid.vx * p.x + grid.vy * p.y + grid.v0)};
}

/// Converts many points; `to` must have space for them.
void position_in_image(std::span<const Point2> points, const PixelGrid& grid, Point2* to);

/// Each row has a line at the distance `line` from its upper border. Writes to `to`, for each point, the
/// first row whose line is not above the point; `height` if there is none.
void find_rows_below(std::span<const Point2> points, const PixelGrid& grid, double line, std::int32_t* to);

/// Writes to `to`, for each point, the index of the band that contains it, -1 if it is above the image, or
/// `count` if it is below. A point that is above a border by less than a rounding error may be assigned to
/// the band below.
void find_bands(std::span<const Point2> points, const PixelGrid& grid, double bands_per_row,
                std::int32_t count, std::int32_t* to);

} // namespace lamella
