#pragma once

// A layer's contours as geometry formats group them: polygons with their holes, and lines.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/polygon/nesting.hpp"

#include "write/grid.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Calls `polygon(first, points)` for each ring that bounds material, on the grid: outer rings (`first`), and
/// after each of them its holes. What the grid leaves nothing of is passed over, an outer ring with its
/// holes.
template <class Ring>
void for_each_polygon(const Layer& layer, const Nesting& nesting, const WriterGrid& grid,
                      std::vector<GridPoint>& scratch, const Ring& ring) {
    const auto put = [&](std::size_t i, bool first) {
        const auto points =
            grid.snap(layer.contour(i), true, ring_area(layer.contour(i)), layer.index, scratch);
        if (!points.empty())
            ring(first, points);
        return !points.empty();
    };
    for (const Polygon& polygon : polygons(nesting)) {
        if (!put(polygon.outer, true))
            continue;
        for (const std::uint32_t hole : polygon.holes)
            put(hole, false);
    }
}

/// Calls `line(points, closed)` for what bounds no material: rings in nothing that run clockwise, rings
/// without area, and open chains.
template <class Line>
void for_each_line(const Layer& layer, const Nesting& nesting, const WriterGrid& grid,
                   std::vector<GridPoint>& scratch, const Line& line) {
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const bool closed = layer.closed(i);
        if (closed && nesting.kind[i] != RingKind::misoriented && nesting.kind[i] != RingKind::flat)
            continue;
        const auto points = grid.snap(layer.contour(i), closed, 0, layer.index, scratch);
        if (!points.empty())
            line(points, closed);
    }
}

} // namespace lamella
