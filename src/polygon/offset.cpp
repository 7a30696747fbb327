#include "lamella/polygon/offset.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/nesting.hpp"

#include "polygon/arrangement.hpp"
#include "polygon/clipping.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

namespace {

using Rings = std::vector<std::span<const Point2>>;

/// Whether nothing is left of these rings of one body when it is shrunk by so much.
bool vanishes(const Rings& body, double by, const ClippingGrid& grid) {
    // All of it lies within `by` of its sides then: that is a strip along each side and a sector at each
    // corner.
    double area = 0;
    double reach = 0;
    for (const std::span<const Point2> ring : body) {
        area += ring_area(ring);
        reach += contour_length(ring, true) * by + static_cast<double>(ring.size()) * 4 * by * by;
    }
    return area <= reach && grown(body, -by, grid).empty();
}

/// How many of these boundaries of material are gone when their bodies are moved by `distance`.
std::uint64_t vanished_rings(const std::vector<Ring>& boundaries, double distance, const ClippingGrid& grid) {
    LayerBuilder builder;
    for (const Ring& ring : boundaries) {
        for (const Point2& p : ring)
            builder.add_point(p);
        builder.end_contour(true);
    }
    const Layer layer = builder.finish(0, 0, 0, 0);
    std::uint64_t count = 0;
    for (const Polygon& body : polygons(nesting(layer))) {
        Rings rings{layer.contour(body.outer)};
        for (const std::uint32_t hole : body.holes) {
            rings.push_back(layer.contour(hole));
            Ring inside(rings.back().rbegin(), rings.back().rend());
            if (distance > 0 && vanishes({inside}, distance, grid))
                ++count;
        }
        if (distance < 0 && vanishes(rings, -distance, grid))
            count += rings.size();
    }
    return count;
}

} // namespace

Layer offset(const Layer& layer, double distance, std::uint64_t* vanished) {
    if (!std::isfinite(distance))
        throw Error(ErrorKind::usage, "contours can be moved by a finite distance only");
    if (vanished != nullptr)
        *vanished = 0;
    if (distance == 0 || layer.rings == 0)
        return layer;
    Rings rings;
    for (std::size_t i = 0; i < layer.rings; ++i)
        rings.push_back(layer.contour(i));
    const std::size_t points = layer.offsets[layer.rings];
    const ClippingGrid grid(layer.points.span().first(points), 2 * std::abs(distance));
    // The library moves every ring by itself. It has to see boundaries of material: where rings overlap, and
    // where a hole runs along its body, no wall must grow out of nothing.
    const std::vector<Ring> united = filled(rings, FillRule::positive, grid);
    if (vanished != nullptr)
        *vanished = vanished_rings(united, distance, grid);
    rings.assign(united.begin(), united.end());
    // What the library gives is right as an area, but its rings may lie upon one another along sides.
    const std::vector<Ring> moved = grown(rings, distance, grid);
    rings.assign(moved.begin(), moved.end());
    LayerBuilder builder;
    for (const Ring& ring : filled(rings, FillRule::positive, grid)) {
        for (const Point2& p : ring)
            builder.add_point(p);
        builder.end_contour(true);
    }
    for (std::size_t i = layer.rings; i < layer.contours(); ++i) {
        for (const Point2& p : layer.contour(i))
            builder.add_point(p);
        builder.end_contour(false);
    }
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

} // namespace lamella
