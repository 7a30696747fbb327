#pragma once

// Draws pixels with the fraction of their area that is covered, if no area is covered twice.

#include "raster/bands.hpp"
#include "raster/coverage_band.hpp"
#include "raster/drawn_row.hpp"
#include "raster/edges.hpp"
#include "raster/grey_values.hpp"

#include <cstdint>
#include <span>

namespace lamella {

/// Draws the rows of an image from the top down. The value of a pixel is the integral of the winding number
/// over its area, which is the coverage if the winding number is 0 or 1 everywhere.
class SummedRows {
  public:
    SummedRows(std::span<const Layer> parts, const PixelGrid& grid, const GreyValues& values);

    [[nodiscard]] DrawnRow draw(std::uint32_t row);
    /// Returns the area that no row shows; the rows show all.
    [[nodiscard]] double between_rows() const noexcept { return 0; }

  private:
    /// Adds the edges between consecutive points.
    void add_line(std::span<const Point2> points);

    Bands bands_;
    std::uint32_t width_;
    std::uint32_t height_;
    double downwards_; ///< weight of an edge that runs downwards: -1 or 1, by the orientation of the grid
    std::uint32_t top_ = 0; ///< first row of the band
    std::uint32_t end_ = 0;
    CoverageBand coverage_;
};

} // namespace lamella
