#pragma once

// Layers in another position.

#include "fixtures/layers.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace lamella::test {

/// Returns the layer rotated around the origin and then moved.
inline Layer turned(const Layer& layer, double degrees, Point2 by) {
    const double angle = degrees * std::numbers::pi / 180;
    std::vector<Contour> rings = contours(layer);
    for (Contour& ring : rings)
        for (Point2& p : ring)
            p = {p.x * std::cos(angle) - p.y * std::sin(angle) + by.x,
                 p.x * std::sin(angle) + p.y * std::cos(angle) + by.y};
    return normal_layer(rings);
}

} // namespace lamella::test
