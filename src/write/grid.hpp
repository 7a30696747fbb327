#pragma once

// Contours on a grid of whole numbers, as text and 16-bit formats store them.

#include "lamella/contour/rounding.hpp"
#include "lamella/core/point.hpp"

#include "write/rounding_loss.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

struct GridPoint {
    std::int64_t x = 0;
    std::int64_t y = 0;

    friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

inline constexpr double text_step_mm = text_rounding.step_mm;

/// Throws Error{usage} for units of LayerWriteOptions that no file can have.
void check_units(double units);

/// The smallest of 1, 2 or 5 times a power of ten that is at least this positive number.
[[nodiscard]] double round_step(double least) noexcept;

/// Signed area of a ring in square steps.
[[nodiscard]] double grid_area(std::span<const GridPoint> ring) noexcept;

class WriterGrid {
  public:
    /// Points at whole multiples of `step_mm`. What that loses of contours goes to `loss`, which must outlive
    /// the grid.
    explicit WriterGrid(double step_mm, RoundingLoss* loss = nullptr);

    /// The nearest point for each of a contour, half-way cases to the even one. Points that fall together
    /// with the one before are dropped; what is left of a ring of fewer than three, or of a chain of fewer
    /// than two points, is nothing. `area` is the ring's before rounding: a ring so thin that rounding turned
    /// it over is listed the other way round, so that outer rings stay outer rings. The result lives in
    /// `scratch`.
    ///
    /// Throws Error{usage}, naming the layer, for coordinates beyond 2^51 steps.
    std::span<const GridPoint> snap(std::span<const Point2> contour, bool closed, double area,
                                    std::uint64_t layer, std::vector<GridPoint>& scratch) const;

    /// The nearest points for lines, two each; lines that shrink to a point are left out. The same error.
    [[nodiscard]] std::vector<GridPoint> snap_lines(std::span<const Point2> points,
                                                    std::uint64_t layer) const;

    /// The nearest points, each for itself. The same error.
    [[nodiscard]] std::vector<GridPoint> snap_points(std::span<const Point2> points,
                                                     std::uint64_t layer) const;

  private:
    void round(std::span<const Point2> points, std::uint64_t layer, GridPoint* out) const;

    [[nodiscard]] double largest_move(std::span<const Point2> points, const GridPoint* rounded) const;

    double step_;
    double per_step_;
    RoundingLoss* loss_; ///< may be null
    bool noticed_;       ///< whether anybody could miss what a move loses
};

} // namespace lamella
