#pragma once

// Pixels by the part of their area that is covered, where nothing is covered twice.

#include "raster/bands.hpp"
#include "raster/coverage_band.hpp"
#include "raster/drawn_row.hpp"
#include "raster/edges.hpp"

#include <cstdint>
#include <span>

namespace lamella {

/// Draws the rows of a picture from the top down: of each pixel the winding number's integral over its area,
/// which is the coverage where that is 0 or 1 everywhere.
class SummedRows {
  public:
    SummedRows(std::span<const Layer> parts, const PixelGrid& grid, double gamma);

    [[nodiscard]] DrawnRow draw(std::uint32_t row);

  private:
    /// Sums up the edges between points that follow one another.
    void add_line(std::span<const Point2> points);

    Bands bands_;
    std::uint32_t width_;
    std::uint32_t height_;
    double downwards_;      ///< the weight of what begins along an edge that runs down the picture
    std::uint32_t top_ = 0; ///< of the band
    std::uint32_t end_ = 0;
    CoverageBand coverage_;
};

} // namespace lamella
