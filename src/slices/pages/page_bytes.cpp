#include "slices/pages/page_bytes.hpp"

#include "lamella/contour/measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella {

namespace {

/// Adds points as differences from the previous point; the first one is relative to `at`.
void add_way(GridPoint at, std::span<const GridPoint> points, NumberBytes& out) {
    for (const GridPoint& p : points) {
        out.add_signed(p.x - at.x);
        out.add_signed(p.y - at.y);
        at = p;
    }
}

/// Adds the counts of rings, chains and hatch lines, and the contours; returns the number of their points.
std::uint64_t add_contours(const Layer& layer, std::size_t hatch_lines, bool vectors, const WriterGrid& grid,
                           GridPoint origin, NumberBytes& out) {
    NumberBytes contours;
    std::uint64_t rings = 0;
    std::uint64_t chains = 0;
    std::uint64_t shown = 0;
    GridPoint first = origin;
    std::vector<GridPoint> scratch;
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const bool closed = layer.closed(i);
        const auto contour = layer.contour(i);
        std::span<const GridPoint> points;
        if (vectors)
            points = scratch = grid.snap_points(contour, layer.index);
        else
            points = grid.snap(contour, closed, closed ? ring_area(contour) : 0, layer.index, scratch);
        if (points.empty())
            continue;
        ++(closed ? rings : chains);
        shown += points.size();
        contours.add(points.size());
        add_way(first, points, contours);
        first = points.front();
    }
    out.add(rings);
    out.add(chains);
    out.add(hatch_lines);
    out.append(contours);
    return shown;
}

} // namespace

double page_step_mm(const Box3& box) {
    constexpr double steps = 50000;
    const double least = std::max(box.max.x - box.min.x, box.max.y - box.min.y) / steps;
    if (!(least > 0) || !std::isfinite(least))
        return 0.001;
    return round_step(least);
}

PageGrid page_grid(const Box3& box) {
    PageGrid grid{.step_mm = page_step_mm(box), .origin = {}};
    const Point2 corner{box.min.x, box.min.y};
    grid.origin = WriterGrid(grid.step_mm).snap_points({&corner, 1}, 0).front();
    return grid;
}

NumberBytes layer_numbers(const Plane& plane, std::span<const PartInfo> parts, std::span<const Point2> places,
                          const PageGrid& grid, std::uint64_t& shown) {
    assert(parts.size() == plane.polylines.size());
    const WriterGrid snapping(grid.step_mm);
    NumberBytes out;
    shown = 0;
    for (std::size_t i = 0; i < plane.polylines.size(); ++i) {
        const Layer& layer = plane.polylines[i];
        const std::span<const Point2> hatches = plane.hatches[i].span();
        shown += add_contours(layer, hatches.size() / 2, parts[i].exposure.has_value(), snapping, grid.origin,
                              out);
        add_way(grid.origin, snapping.snap_points(hatches, layer.index), out);
    }
    out.add(places.size());
    add_way(grid.origin,
            snapping.snap_points(places, plane.polylines.empty() ? 0 : plane.polylines.front().index), out);
    return out;
}

} // namespace lamella
