#pragma once

// Contours in single precision, as binary formats store them.

#include "lamella/core/point.hpp"

#include "slices/engine/rounding_loss.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// Bytes of x and y in a file.
inline constexpr std::size_t float_point_size = 8;

struct FloatContour {
    std::size_t points = 0; ///< number of written points, including the repeated one of a ring; 0 if lost
    double area_mm2 = 0;    ///< of a ring, before rounding
};

/// Converts millimetres to numbers in single precision, x and y in turn.
class FloatContours {
  public:
    /// Multiplies coordinates by `per_mm`. Losses by rounding are counted in `loss`, which must outlive this
    /// object.
    explicit FloatContours(double per_mm, RoundingLoss* loss = nullptr) : per_mm_(per_mm), loss_(loss) {}

    /// Writes a contour, each coordinate rounded to the nearest single; a ring repeats its first point at the
    /// end. There must be space for one point more than the contour has. Drops points equal to the previous
    /// point. Leaves out a ring of fewer than three remaining points, or a chain of fewer than two. A ring so
    /// thin that rounding reversed its orientation is written in reverse order, so that outer rings stay
    /// outer rings.
    ///
    /// Throws Error{usage}, naming the layer, for coordinates beyond single precision.
    FloatContour put(std::span<const Point2> contour, bool closed, std::uint64_t layer, char* out) const;

    /// Writes lines, two points each; lines that shrink to a point are left out. Returns the number of
    /// remaining points. Throws Error{usage} as `put` does.
    std::size_t put_lines(std::span<const Point2> points, std::uint64_t layer, char* out) const;

  private:
    /// Returns whether a move by this much, in written units, must be reported.
    [[nodiscard]] bool is_noticed(double moved) const;

    double per_mm_;
    RoundingLoss* loss_;
};

} // namespace lamella
