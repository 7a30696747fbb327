#pragma once

// Contours on an integer grid, as text and 16-bit formats store them.

#include "lamella/contour/rounding.hpp"
#include "lamella/core/point.hpp"

#include "slices/engine/rounding_loss.hpp"

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

/// Throws Error{usage} for invalid values of LayerWriteOptions::units_mm.
void check_units(double units);

/// Returns the smallest of 1, 2 or 5 times a power of ten that is at least this positive number.
[[nodiscard]] double round_step(double least) noexcept;

/// Returns the signed area of a ring in square steps.
[[nodiscard]] double grid_area(std::span<const GridPoint> ring) noexcept;

class WriterGrid {
  public:
    /// Creates a grid of points at integer multiples of `step_mm`. Losses of contours are counted in `loss`,
    /// which must outlive the grid.
    explicit WriterGrid(double step_mm, RoundingLoss* loss = nullptr);

    /// Returns the nearest grid point of each point of a contour, ties to even. Drops points equal to the
    /// previous point. Returns nothing for a ring of fewer than three remaining points, or for a chain of
    /// fewer than two. `area` is the area of the ring before rounding. A ring so thin that rounding reversed
    /// its orientation is returned in reverse order, so that outer rings stay outer rings. The result is
    /// stored in `scratch`.
    ///
    /// Throws Error{usage}, naming the layer, for coordinates beyond 2^51 steps.
    std::span<const GridPoint> snap(std::span<const Point2> contour, bool closed, double area,
                                    std::uint64_t layer, std::vector<GridPoint>& scratch) const;

    /// Returns the nearest grid points of the ends of lines. Leaves out lines that shrink to a point. Throws
    /// Error{usage} as `snap` does.
    [[nodiscard]] std::vector<GridPoint> snap_lines(std::span<const Point2> points,
                                                    std::uint64_t layer) const;

    /// Returns the nearest grid point of each point. Throws Error{usage} as `snap` does.
    [[nodiscard]] std::vector<GridPoint> snap_points(std::span<const Point2> points,
                                                     std::uint64_t layer) const;

  private:
    void round(std::span<const Point2> points, std::uint64_t layer, GridPoint* out) const;

    [[nodiscard]] double largest_move(std::span<const Point2> points, const GridPoint* rounded) const;

    double step_;
    double per_step_;
    RoundingLoss* loss_; ///< may be null
    bool noticed_;       ///< true if moves by rounding must be reported
};

} // namespace lamella
