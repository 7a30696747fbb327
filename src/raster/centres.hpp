#pragma once

// Pixels that are covered, or not, as their centres are.

#include "lamella/raster/picture.hpp"

#include "raster/coverage_row.hpp"
#include "raster/edges.hpp"
#include "raster/row_sweep.hpp"

#include <cstdint>
#include <span>

namespace lamella {

/// Where an edge crosses the centres of a row.
struct CentreCrossing {
    [[nodiscard]] static RowRange rows(const PictureEdge& edge, std::uint32_t height) noexcept;
    CentreCrossing(const PictureEdge& edge, std::uint32_t row) noexcept { move_to(edge, row); }
    void move_to(const PictureEdge& edge, std::uint32_t row) noexcept { column = edge.column(row + 0.5); }
    bool operator<(const CentreCrossing& other) const noexcept { return column < other.column; }

    double column = 0;
};

/// Draws the rows of a picture from the top down, each into an empty CoverageRow of full coverage 1.
class CentreRows {
  public:
    CentreRows(std::span<const PictureEdge> edges, std::uint32_t height) : crossings_(edges, height) {}

    /// Says how many rows from there on look the same.
    std::uint32_t draw(std::uint32_t row, CoverageRow& out);

  private:
    RowSweep<CentreCrossing> crossings_;
};

} // namespace lamella
