#include "raster/edges.hpp"

#include "core/vector_clones.hpp"

#include <cstddef>

namespace lamella {

LAMELLA_VECTOR_CLONES void position_in_image(std::span<const Point2> points, const PixelGrid& grid,
                                             Point2* to) {
    for (std::size_t i = 0; i < points.size(); ++i)
        to[i] = position_in_image(points[i], grid);
}

LAMELLA_VECTOR_CLONES void find_rows_below(std::span<const Point2> points, const PixelGrid& grid, double line,
                                           std::int32_t* to) {
    const double most = grid.height;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point2 p = points[i];
        const double v = (grid.vx * p.x + grid.vy * p.y + grid.v0) - line;
        const double within = v < most ? (v > 0 ? v : 0) : most;
        const auto whole = static_cast<std::int32_t>(within);
        to[i] = whole + (whole < within ? 1 : 0);
    }
}

LAMELLA_VECTOR_CLONES void find_bands(std::span<const Point2> points, const PixelGrid& grid,
                                      double bands_per_row, std::int32_t count, std::int32_t* to) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point2 p = points[i];
        // One more than the band, so that truncating the fraction rounds down.
        const double band = (grid.vx * p.x + grid.vy * p.y + grid.v0) * bands_per_row + 1;
        to[i] = static_cast<std::int32_t>(band > 0 ? (band < count + 1 ? band : count + 1) : 0) - 1;
    }
}

} // namespace lamella
