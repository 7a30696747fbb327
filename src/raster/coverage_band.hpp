#pragma once

// Rows of pixels under construction, with their coverage.

#include "lamella/raster/image.hpp"

#include "raster/edges.hpp"
#include "raster/grey_values.hpp"
#include "raster/row_changes.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Sums up the coverage of the pixels of a few rows from the points where material begins and ends.
class CoverageBand {
  public:
    CoverageBand(std::uint32_t width, std::uint32_t rows, const GreyValues& values);

    /// Adds material whose weight increases linearly from 0 at u = `from` to `weight` at u = `to`, and is
    /// `weight` from there to the end of the row. A negative weight ends material.
    void begin_along(std::uint32_t row, double from, double to, double weight);
    /// Adds material that begins along an edge, in the rows from `top`, the first row of the band, to `end`.
    void begin_along(const ImageEdge& edge, std::uint32_t top, std::uint32_t end, double weight);
    /// Adds material that begins within a pixel. `moment` is the weight times the distance of its begin from
    /// the left border of the pixel.
    void begin_within(std::uint32_t row, std::size_t column, double weight, double moment) {
        own_.row(row).add_from(column, weight - moment, moment);
    }
    /// Adds material that begins at u to all rows, including later uses of rows that were already taken,
    /// until clear_common().
    void begin_in_all(double u, double weight);
    void clear_common() { common_.clear(0); }

    /// Returns whether a row has no material but that of begin_in_all.
    [[nodiscard]] bool plain(std::uint32_t row) const noexcept { return !own_.touched(row); }
    /// Returns the row as runs, valid until the next call. Clears the row except for the material of
    /// begin_in_all.
    [[nodiscard]] std::span<const PixelRun> take(std::uint32_t row);
    /// Returns the covered area, in pixels, of the row that was taken last.
    [[nodiscard]] double covered() const noexcept { return covered_; }
    /// Returns the area, in pixels, of the material in pixels of that row that are too little covered to be
    /// seen.
    [[nodiscard]] double unseen() const noexcept { return unseen_; }

  private:
    std::uint32_t width_;
    RowChanges own_;    ///< changes of the coverage in each row
    RowChanges common_; ///< one row: changes that all rows have in common
    GreyValues value_of_;
    std::vector<PixelRun> runs_;
    double covered_ = 0;
    double unseen_ = 0;
};

} // namespace lamella
