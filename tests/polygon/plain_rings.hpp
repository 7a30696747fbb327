#pragma once

// Random rings, and their winding numbers by a loop over all sides.

#include "lamella/contour/layer.hpp"

#include "core/orientation.hpp"
#include "fixtures/layers.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace lamella::test {

/// Returns how many times a ring runs counter-clockwise around a point. Exact for points not on the ring.
inline int plain_winding(std::span<const Point2> ring, const Point2& p) {
    int winding = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2& a = ring[i];
        const Point2& b = ring[(i + 1) % ring.size()];
        if ((a.y <= p.y) != (b.y <= p.y) && orientation(a, b, p) == (a.y < b.y ? 1 : -1))
            winding += a.y < b.y ? 1 : -1;
    }
    return winding;
}

inline int plain_winding(const Layer& layer, const Point2& p) {
    int winding = 0;
    for (std::size_t i = 0; i < layer.rings; ++i)
        winding += plain_winding(layer.contour(i), p);
    return winding;
}

/// Returns rings of random points, which cross themselves and others. On integers they also touch and share
/// sides.
inline std::vector<Contour> tangled_rings(Random& random, bool integers) {
    std::vector<Contour> rings;
    for (std::int64_t n = random.integer(1, 6); n > 0; --n) {
        Contour& ring = rings.emplace_back();
        for (std::int64_t k = random.integer(3, 8); k > 0; --k) {
            if (integers) {
                const auto x = static_cast<double>(random.integer(0, 12));
                ring.push_back({x, static_cast<double>(random.integer(0, 12))});
            } else {
                const double x = random.real(0, 12);
                ring.push_back({x, random.real(0, 12)});
            }
        }
    }
    return rings;
}

/// Returns a ring around a centre that does not cross itself, counter-clockwise, with radii between half of
/// `radius` and `radius`.
inline Contour star(Random& random, const Point2& centre, double radius) {
    Contour ring;
    const std::int64_t n = random.integer(3, 40);
    for (std::int64_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.1) / static_cast<double>(n);
        const double r = radius * random.real(0.5, 1);
        ring.push_back({centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)});
    }
    return ring;
}

/// Returns stars that lie apart or within one another, in either direction, without contacts.
inline std::vector<Contour> nested_stars(Random& random) {
    std::vector<Contour> rings;
    for (std::int64_t n = random.integer(1, 9); n > 0; --n) {
        const Point2 centre{30 * static_cast<double>(n % 3) + random.real(0, 1),
                            30 * static_cast<double>(n / 3) + random.real(0, 1)};
        double radius = 12;
        for (std::int64_t depth = random.integer(1, 4); depth > 0; --depth) {
            // An inscribed circle of a triangle of this radius has at least an eighth of it.
            const Contour ring = star(random, centre, radius);
            rings.push_back(random.integer(0, 1) == 0 ? ring : reversed(ring));
            radius /= 9;
        }
    }
    return rings;
}

} // namespace lamella::test
