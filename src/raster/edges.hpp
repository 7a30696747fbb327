#pragma once

// The edges of contours, as a picture sees them.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"
#include "lamella/raster/picture.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Where edges lie of which only that they are to the left of the picture makes a difference.
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

    /// The column at height v, if that lies between the ends.
    [[nodiscard]] double column(double v) const noexcept {
        const auto [low, high] = std::minmax(upper.x, lower.x);
        return std::clamp(upper.x + (v - upper.y) * slope, low, high);
    }
    [[nodiscard]] bool level() const noexcept { return upper.y == lower.y; }
};

/// Of all closed rings, those edges that lie in the picture's rows and not to the right of it. Where an edge
/// lies to the left of the picture makes no difference, so it is upright there, and level ones are missing.
[[nodiscard]] std::vector<PictureEdge> picture_edges(std::span<const Layer> parts, const PixelGrid& grid);

} // namespace lamella
