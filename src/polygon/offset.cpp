#include "lamella/polygon/offset.hpp"

#include "lamella/core/error.hpp"

#include "polygon/arrangement.hpp"
#include "polygon/clipping.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace lamella {

Layer offset(const Layer& layer, double distance) {
    if (!std::isfinite(distance))
        throw Error(ErrorKind::usage, "contours can be moved by a finite distance only");
    if (distance == 0 || layer.rings == 0)
        return layer;
    std::vector<std::span<const Point2>> rings;
    for (std::size_t i = 0; i < layer.rings; ++i)
        rings.push_back(layer.contour(i));
    const std::size_t points = layer.offsets[layer.rings];
    const ClippingGrid grid(layer.points.span().first(points), 2 * std::abs(distance));
    // The library moves every ring by itself. It has to see boundaries of material: where rings overlap, and
    // where a hole runs along its body, no wall must grow out of nothing.
    const std::vector<Ring> united = filled(rings, FillRule::positive, 0, grid);
    rings.assign(united.begin(), united.end());
    // What the library gives is right as an area, but its rings may lie upon one another along sides.
    const std::vector<Ring> moved = grown(rings, distance, grid);
    rings.assign(moved.begin(), moved.end());
    LayerBuilder builder;
    for (const Ring& ring : filled(rings, FillRule::positive, 0, grid)) {
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
