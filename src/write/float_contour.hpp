#pragma once

// Contours in single precision, as binary formats store them.

#include "lamella/core/point.hpp"

#include "write/rounding_loss.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// x and y as they stand in a file.
inline constexpr std::size_t float_point_size = 8;

struct FloatContour {
    std::size_t points = 0; ///< listed, the repeated first one of a ring included; 0 when nothing is left
    double area_mm2 = 0;    ///< of a ring, before rounding
};

/// Millimetres to numbers in single precision, x and y in turn.
class FloatContours {
  public:
    /// Coordinates are multiplied by `per_mm`. What rounding loses of contours goes to `loss`, which must
    /// outlive this.
    explicit FloatContours(double per_mm, RoundingLoss* loss = nullptr) : per_mm_(per_mm), loss_(loss) {}

    /// Writes a contour, each coordinate rounded to the nearest single; a ring ends with its first point once
    /// more. There must be room for one point more than the contour has. Points that fall together with the
    /// one before are dropped; what is left of a ring of fewer than three, or of a chain of fewer than two
    /// points, is nothing. A ring so thin that rounding turned it over is listed the other way round, so that
    /// outer rings stay outer rings.
    ///
    /// Throws Error{usage}, naming the layer, for coordinates beyond single precision.
    FloatContour put(std::span<const Point2> contour, bool closed, std::uint64_t layer, char* out) const;

    /// Writes lines, two points each; lines that shrink to a point are left out. Returns the points of those
    /// that stay. The same error.
    std::size_t put_lines(std::span<const Point2> points, std::uint64_t layer, char* out) const;

  private:
    /// Whether anybody could miss what a move by so much, in what is written, loses.
    [[nodiscard]] bool is_noticed(double moved) const;

    double per_mm_;
    RoundingLoss* loss_;
};

} // namespace lamella
