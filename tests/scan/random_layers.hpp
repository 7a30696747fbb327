#pragma once

// Layers to hatch.

#include "lamella/polygon/fill.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"

#include <utility>
#include <vector>

namespace lamella::test {

/// Returns rings of random points on a grid, which cross, touch, overlap along edges and share vertices.
inline Layer random_rings(Random& random, std::int64_t extent) {
    std::vector<Contour> rings;
    const std::int64_t count = random.integer(1, 6);
    for (std::int64_t i = 0; i < count; ++i) {
        Contour ring;
        const std::int64_t corners = random.integer(1, 9);
        for (std::int64_t k = 0; k < corners; ++k)
            ring.push_back({static_cast<double>(random.integer(0, extent)),
                            static_cast<double>(random.integer(0, extent))});
        rings.push_back(std::move(ring));
    }
    return layer_of(rings);
}

/// Returns material as `scan` hatches it.
inline Layer random_material(Random& random, std::int64_t extent) {
    return fill(random_rings(random, extent), FillRule::nonzero).layer;
}

/// Returns the layer scaled by a factor.
inline Layer scaled(const Layer& layer, double by) {
    Layer result = layer;
    std::vector<Point2> points(layer.points.begin(), layer.points.end());
    for (Point2& p : points)
        p = {p.x * by, p.y * by};
    result.points = PointArray(std::move(points));
    return result;
}

} // namespace lamella::test
