#include "polygon/simple_polygons.hpp"

#include "lamella/polygon/nesting.hpp"

#include "core/layer_budget.hpp"
#include "polygon/boundary.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

namespace lamella {

namespace {

/// Divides a ring at each point that it visits several times, and adds the loops to a layer. The boundary of
/// material comes back to a point only around a hole that touches there (see `boundary`), so each loop is a
/// hole or what is around all of them.
void add_loops(std::span<const Point2> ring, LayerBuilder& layer) {
    std::vector<Point2> way;
    std::map<Point2, std::size_t> position; // of the points on the way
    const auto end_loop = [&](std::size_t begin) {
        const std::span<const Point2> loop = std::span(way).subspan(begin);
        layer.add_contour(loop, true);
        for (const Point2& p : loop)
            position.erase(p);
        way.resize(begin);
    };
    for (const Point2& p : ring) {
        if (const auto before = position.find(p); before != position.end())
            end_loop(before->second);
        position.emplace(p, way.size());
        way.push_back(p);
    }
    end_loop(0);
}

} // namespace

std::vector<SimplePolygon> simple_polygons(const Layer& whole, const LayerLimits& limits) {
    std::vector<std::span<const Point2>> rings;
    for (std::size_t i = 0; i < whole.rings; ++i)
        rings.push_back(whole.contour(i));
    if (rings.empty())
        return {};
    const ClippingGrid grid =
        ClippingGrid::of_integers(whole.points.span().first(whole.offsets[whole.rings]));
    LayerBuilder builder;
    for (const Ring& ring :
         filled(rings, FillRule::positive, grid, LayerBudget(limits, whole.index, whole.z)))
        add_loops(ring, builder);
    const Layer loops = builder.finish(whole.index, whole.z, whole.bottom, whole.top);
    const auto ring_of = [&](std::uint32_t i) {
        const std::span<const Point2> points = loops.contour(i);
        return Ring(points.begin(), points.end());
    };
    std::vector<SimplePolygon> result;
    for (const Polygon& polygon : polygons(nesting(loops, limits))) {
        SimplePolygon& simple = result.emplace_back(SimplePolygon{ring_of(polygon.outer), {}});
        for (const std::uint32_t hole : polygon.holes)
            simple.holes.push_back(ring_of(hole));
    }
    return result;
}

} // namespace lamella
