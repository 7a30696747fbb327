#include "raster/edges.hpp"

#include "core/vector_clones.hpp"

#include <cstddef>

namespace lamella {

LAMELLA_VECTOR_CLONES void place_in_picture(std::span<const Point2> points, const PixelGrid& grid,
                                            Point2* to) {
    constexpr double far = 0x1p40;
    const auto near = [](double c) __attribute__((always_inline)) { // a number also for what overflowed
        return c < far ? (c > -far ? c : -far) : far;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point2 p = points[i];
        to[i] = {near(grid.ux * p.x + grid.uy * p.y + grid.u0),
                 near(grid.vx * p.x + grid.vy * p.y + grid.v0)};
    }
}

LAMELLA_VECTOR_CLONES void find_bands(std::span<const Point2> points, const PixelGrid& grid,
                                      double bands_per_row, std::int32_t count, std::int32_t* to) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point2 p = points[i];
        // One more than the band, so that to cut off the fraction is to go down.
        const double band = (grid.vx * p.x + grid.vy * p.y + grid.v0) * bands_per_row + 1;
        to[i] = static_cast<std::int32_t>(band > 0 ? (band < count + 1 ? band : count + 1) : 0) - 1;
    }
}

} // namespace lamella
