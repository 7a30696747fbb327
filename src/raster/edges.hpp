#pragma once

// The edges of contours, as a picture sees them.

#include "lamella/core/point.hpp"
#include "lamella/raster/picture.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace lamella {

/// Where edges lie that are to the left of the picture: how far makes no difference.
inline constexpr double left_of_picture = -1;

/// The least whole number that is not below v, between 0 and `most`. (To ask std::ceil is a call, where
/// processors of all kinds are compiled for.)
[[nodiscard]] inline std::uint32_t least_whole(double v, std::uint32_t most) noexcept {
    if (!(v > 0))
        return 0;
    if (v >= most)
        return most;
    const auto whole = static_cast<std::uint32_t>(v);
    return whole + (whole < v ? 1 : 0);
}

/// An edge in columns and rows, from its upper to its lower end whichever way it runs: a border that two
/// bodies share is one line.
struct PictureEdge {
    Point2 upper;
    Point2 lower;
    double slope = 0;         ///< columns per row; 0 for a level edge
    std::int32_t winding = 0; ///< 1 if the ring runs downwards here, else -1

    /// Of the edge of a ring that runs between these points.
    PictureEdge(const Point2& from, const Point2& to) noexcept {
        const bool down = from.y < to.y;
        upper = down ? from : to;
        lower = down ? to : from;
        winding = down ? 1 : -1;
        if (std::max(from.x, to.x) <= 0)
            upper.x = lower.x = left_of_picture;
        if (!level())
            slope = (lower.x - upper.x) / (lower.y - upper.y);
    }
    /// The column at height v, if that lies between the ends.
    [[nodiscard]] double column(double v) const noexcept {
        const auto [low, high] = std::minmax(upper.x, lower.x);
        return std::clamp(upper.x + (v - upper.y) * slope, low, high);
    }
    [[nodiscard]] bool level() const noexcept { return upper.y == lower.y; }
};

/// Where a point is in a picture. A coordinate beyond 2^40 pixels is taken for that many: far outside, and
/// still a number to count with.
[[nodiscard]] __attribute__((always_inline)) inline Point2 place_in_picture(const Point2& p,
                                                                            const PixelGrid& grid) noexcept {
    constexpr double far = 0x1p40;
    const auto near = [](double c) __attribute__((always_inline)) { // a number also for what overflowed
        return c < far ? (c > -far ? c : -far) : far;
    };
    return {near(grid.ux * p.x + grid.uy * p.y + grid.u0), near(grid.vx * p.x + grid.vy * p.y + grid.v0)};
}

/// The same for many; `to` has room for them.
void place_in_picture(std::span<const Point2> points, const PixelGrid& grid, Point2* to);

/// Writes to `to` the first of the rows 0 to height - 1 whose line, so far below the row's upper border, is
/// not above the point; `height` if there is none.
void find_rows_below(std::span<const Point2> points, const PixelGrid& grid, double line, std::int32_t* to);

/// Writes to `to` in which bands of a picture points lie: from 0 to count - 1, -1 for those above and `count`
/// for those below. A point half a rounding above a border may be taken for one below.
void find_bands(std::span<const Point2> points, const PixelGrid& grid, double bands_per_row,
                std::int32_t count, std::int32_t* to);

} // namespace lamella
