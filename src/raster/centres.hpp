#pragma once

// Draws pixels that are covered if their centres are.

#include "lamella/raster/image.hpp"

#include "raster/drawn_row.hpp"
#include "raster/edges.hpp"
#include "raster/row_sweep.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The point where an edge crosses the line through the centres of a row.
struct CentreCrossing {
    static constexpr double line = 0.5;
    static constexpr bool only_on_lines = true;
    [[nodiscard]] static std::uint32_t first(double /*y*/, std::uint32_t below) noexcept { return below; }
    CentreCrossing(const ImageEdge& edge, std::uint32_t row) noexcept { move_to(edge, row); }
    void move_to(const ImageEdge& edge, std::uint32_t row) noexcept { column = edge.column(row + 0.5); }
    bool operator<(const CentreCrossing& other) const noexcept { return column < other.column; }

    double column = 0;
};

/// Draws the rows of an image from the top down.
class CentreRows {
  public:
    CentreRows(std::span<const Layer> parts, const PixelGrid& grid);

    [[nodiscard]] DrawnRow draw(std::uint32_t row);
    /// Returns the area, in pixels, of bodies and fins between the lines through the centres of rows.
    [[nodiscard]] double between_rows() const noexcept { return between_rows_; }

  private:
    /// Covers the columns from `from` to `to`. `from` must not be less than the previous `to`.
    void cover(std::uint32_t from, std::uint32_t to);

    /// Material between two crossings that covers no centre.
    struct Gap {
        double from;
        double to;
        bool counted;
    };

    /// Returns the unseen area of `times` equal rows that are drawn now.
    double unseen(std::uint32_t times);

    RowSweep<CentreCrossing> crossings_;
    std::uint32_t width_;
    std::vector<PixelRun> runs_;
    std::uint32_t covered_ = 0;
    std::vector<Gap> gaps_;       ///< of this row
    std::vector<Gap> gaps_above_; ///< of the previous row
    double between_rows_ = 0;
};

} // namespace lamella
