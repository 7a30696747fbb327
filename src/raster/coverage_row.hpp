#pragma once

// A row of pixels under construction.

#include "lamella/raster/picture.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Sums up how far the pixels of a row are covered, from the places where material begins and ends. Only
/// these places cost time, not the pixels between them: a bit for each column tells where they are.
class CoverageRow {
  public:
    /// `full` is the coverage of a pixel that gets the value 255.
    CoverageRow(std::uint32_t width, double full, double gamma);

    /// Material of the given weight along a slope, from nothing at u = `from` to all of it at `to` and until
    /// the end of the row; a negative weight ends it.
    void begin_along(double from, double to, double weight);

    /// The row as runs, which live until the next call. The row is empty afterwards.
    [[nodiscard]] std::span<const PixelRun> take();
    /// Covered pixels of the row that was taken last.
    [[nodiscard]] double covered() const noexcept { return covered_; }

  private:
    void change(std::size_t column, double by) {
        changes_[column] += by;
        changed_[column / 64] |= std::uint64_t{1} << (column % 64);
    }

    std::uint32_t width_;
    double full_;
    std::vector<double> changes_;        ///< of the coverage from one column to the next
    std::vector<std::uint64_t> changed_; ///< which of them are not zero
    std::array<std::uint8_t, 256> value_of_{};
    std::vector<PixelRun> runs_;
    double covered_ = 0;
};

} // namespace lamella
