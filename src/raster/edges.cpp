#include "raster/edges.hpp"

#include <cstddef>

namespace lamella {

namespace {

/// A coordinate beyond these many pixels is taken for this many: far outside, and still a number to count
/// with.
constexpr double far = 0x1p40;

double near(double c) noexcept { // a number also for what overflowed
    return c < far ? (c > -far ? c : -far) : far;
}

Point2 place(const Point2& p, const PixelGrid& grid) noexcept {
    return {near(grid.ux * p.x + grid.uy * p.y + grid.u0), near(grid.vx * p.x + grid.vy * p.y + grid.v0)};
}

void add_edge(const Point2& from, const Point2& to, const PixelGrid& grid, std::vector<PictureEdge>& edges) {
    const bool down = from.y < to.y;
    PictureEdge edge{.upper = down ? from : to, .lower = down ? to : from, .winding = down ? 1 : -1};
    if (edge.lower.y <= 0 || edge.upper.y >= grid.height || std::min(from.x, to.x) >= grid.width)
        return;
    if (std::max(from.x, to.x) <= 0) {
        if (edge.level())
            return;
        edge.upper.x = edge.lower.x = left_of_picture;
    }
    if (!edge.level())
        edge.slope = (edge.lower.x - edge.upper.x) / (edge.lower.y - edge.upper.y);
    edges.push_back(edge);
}

} // namespace

std::vector<PictureEdge> picture_edges(std::span<const Layer> parts, const PixelGrid& grid) {
    std::vector<PictureEdge> edges;
    std::size_t points = 0;
    for (const Layer& layer : parts)
        points += layer.points.size();
    edges.reserve(points);
    for (const Layer& layer : parts) {
        for (std::size_t i = 0; i < layer.rings; ++i) {
            const std::span<const Point2> ring = layer.contour(i);
            if (ring.empty())
                continue;
            Point2 from = place(ring.back(), grid);
            for (const Point2& point : ring) {
                const Point2 to = place(point, grid);
                add_edge(from, to, grid, edges);
                from = to;
            }
        }
    }
    return edges;
}

} // namespace lamella
