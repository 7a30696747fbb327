#pragma once

// Rows of pixels under construction, by the part of them that is covered.

#include "lamella/raster/picture.hpp"

#include "raster/edges.hpp"
#include "raster/row_changes.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Sums up how far the pixels of a few rows are covered, from the places where material begins and ends.
class CoverageBand {
  public:
    CoverageBand(std::uint32_t width, std::uint32_t rows, double gamma);

    /// Material of the given weight along a slope, from nothing at u = `from` to all of it at `to` and until
    /// the end of the row; a negative weight ends it.
    void begin_along(std::uint32_t row, double from, double to, double weight);
    /// The same along an edge, in the rows from `top` to `end` of the picture, the first of which is the
    /// first of the band.
    void begin_along(const PictureEdge& edge, std::uint32_t top, std::uint32_t end, double weight);
    /// Within a pixel: what begins in it, and that times how far to the right, from 0 to 1, it does.
    void begin_within(std::uint32_t row, std::size_t column, double weight, double moment) {
        own_.row(row).add_from(column, weight - moment, moment);
    }
    /// In all rows of the band, those that were taken and those to come, until clear_common().
    void begin_in_all(double u, double weight);
    void clear_common() { common_.clear(0); }

    /// Whether a row has no material but that of all rows.
    [[nodiscard]] bool plain(std::uint32_t row) const noexcept { return !own_.touched(row); }
    /// The row as runs, which live until the next call. Only the material of all rows stays in it.
    [[nodiscard]] std::span<const PixelRun> take(std::uint32_t row);
    /// Covered pixels of the row that was taken last.
    [[nodiscard]] double covered() const noexcept { return covered_; }

  private:
    std::uint32_t width_;
    RowChanges own_;    ///< of the coverage, for each row
    RowChanges common_; ///< one row: what all have in common
    std::array<std::uint8_t, 256> value_of_{};
    std::vector<PixelRun> runs_;
    double covered_ = 0;
};

} // namespace lamella
