#pragma once

// An integer grid over a layer, to which crossings of contours are rounded.

#include "lamella/core/point.hpp"

#include <span>
#include <vector>

namespace lamella {

using Ring = std::vector<Point2>;

/// A square grid. Its unit is a power of two: at most 2^-36 of the layer's extent (about 1e-9 mm for 100 mm)
/// or, far from the origin, one unit in the last place of the largest coordinate.
class ClippingGrid {
  public:
    /// `margin` is the largest distance of results from the points. Throws Error{limit} if coordinates are
    /// too large.
    explicit ClippingGrid(std::span<const Point2> points, double margin = 0);

    /// Returns a grid that contains these points, whose coordinates are integers below 2^36 in their distance
    /// from one another; a coarser grid of integers if they are farther apart.
    [[nodiscard]] static ClippingGrid of_integers(std::span<const Point2> points);

    [[nodiscard]] double unit() const noexcept { return unit_; }
    /// Returns the nearest grid position, as integers of at most about 2^37.
    [[nodiscard]] Point2 position(const Point2& p) const noexcept;
    [[nodiscard]] Point2 point(const Point2& position) const noexcept {
        return {(origin_.x + position.x) * unit_ + 0.0, (origin_.y + position.y) * unit_ + 0.0};
    }

  private:
    ClippingGrid(std::span<const Point2> points, double margin, int least_exponent);

    double unit_ = 1;
    Point2 origin_; ///< in units
};

} // namespace lamella
