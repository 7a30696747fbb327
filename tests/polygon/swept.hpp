#pragma once

// Material, and the strips and wedges that its sides and corners sweep when they are moved.

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace lamella::test {

/// Stars and boxes that may overlap, with the boundaries of their material.
inline Layer random_material(Random& random, bool integers) {
    std::vector<Contour> rings;
    for (std::int64_t c = random.integer(1, 5); c > 0; --c) {
        const double x = random.real(0, 20);
        const double y = random.real(0, 20);
        Contour ring;
        const std::int64_t n = random.integer(3, 9);
        for (std::int64_t i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
            const double r = random.real(1, 8);
            Point2 p{x + r * std::cos(angle), y + r * std::sin(angle)};
            if (integers)
                p = {std::round(p.x), std::round(p.y)};
            if (ring.empty() || ring.back() != p)
                ring.push_back(p);
        }
        rings.push_back(random.integer(0, 3) == 0 ? reversed(ring) : ring);
    }
    return fill(normal_form(layer_of(rings)), FillRule::positive).layer;
}

/// The same layer with corners cut off and sides in several pieces, some of them short, some a little off the
/// line.
inline Layer in_pieces(const Layer& layer, Random& random) {
    std::vector<Contour> rings;
    for (std::size_t r = 0; r < layer.rings; ++r) {
        Contour& ring = rings.emplace_back();
        for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
            const Point2& a = layer.contour(r)[i];
            const Point2& b = layer.contour(r)[(i + 1) % layer.contour(r).size()];
            const auto along = [&](double t, double off) {
                return Point2{a.x + t * (b.x - a.x) - off * (b.y - a.y),
                              a.y + t * (b.y - a.y) + off * (b.x - a.x)};
            };
            const double cut = random.integer(0, 2) == 0 ? random.real(1e-6, 0.1) : 0;
            const double off = random.integer(0, 1) == 0 ? 0 : random.real(-1e-3, 1e-3);
            ring.push_back(along(cut, 0));
            for (double t = cut; t < 0.8; t += random.real(1e-7, 0.3) * random.real(0, 1))
                ring.push_back(along(t + 0.01, off * random.real(0, 1)));
            ring.push_back(along(0.9, 0));
            ring.push_back(along(0.95, off));
        }
    }
    return fill(normal_form(layer_of(rings)), FillRule::positive).layer;
}

/// Whether sides of its rings run along one another: with nothing between them, they count as none.
inline bool has_walls(const Layer& layer) {
    std::vector<std::pair<Point2, Point2>> sides;
    for (std::size_t r = 0; r < layer.rings; ++r)
        for (std::size_t i = 0; i < layer.contour(r).size(); ++i)
            sides.emplace_back(layer.contour(r)[i], layer.contour(r)[(i + 1) % layer.contour(r).size()]);
    const auto along = [](const auto& s, const Point2& p) {
        return (p.x - s.first.x) * (s.second.x - s.first.x) + (p.y - s.first.y) * (s.second.y - s.first.y);
    };
    const auto across = [](const auto& s, const Point2& p) {
        return (p.y - s.first.y) * (s.second.x - s.first.x) - (p.x - s.first.x) * (s.second.y - s.first.y);
    };
    for (const auto& s : sides)
        for (const auto& t : sides)
            if (&s != &t && std::abs(across(s, t.first)) < 1e-9 && std::abs(across(s, t.second)) < 1e-9 &&
                std::max(along(s, t.first), along(s, t.second)) > 1e-9 &&
                std::min(along(s, t.first), along(s, t.second)) < along(s, s.second) - 1e-9)
                return true;
    return false;
}

/// The strips and wedges that sides and corners sweep, each a ring counter-clockwise.
inline Layer swept(const Layer& layer, double distance, const OffsetCorners& corners) {
    std::vector<Contour> rings;
    const auto add = [&](Contour ring) {
        rings.push_back(ring_area(ring) < 0 ? reversed(ring) : ring);
    };
    for (std::size_t r = 0; r < layer.rings; ++r) {
        Contour ring;
        for (const Point2& p : layer.contour(r))
            if (ring.empty() || p != ring.back())
                ring.push_back(p);
        const std::size_t n = ring.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Point2& a = ring[(i + n - 1) % n];
            const Point2& b = ring[i];
            const Point2& c = ring[(i + 1) % n];
            const double angle = std::atan2(b.y - a.y, b.x - a.x);
            const double turn =
                std::remainder(std::atan2(c.y - b.y, c.x - b.x) - angle, 2 * std::numbers::pi);
            const auto around = [&](double by,
                                    double times) { // from b, to the right of the side, turned by `by`
                return Point2{b.x + times * distance * std::sin(angle + by),
                              b.y - times * distance * std::cos(angle + by)};
            };
            const Point2 to = around(0, 1);
            add({a, b, to, {to.x - b.x + a.x, to.y - b.y + a.y}});
            if (turn * distance <= 0)
                continue;
            Contour wedge{b, to};
            if (corners.shape == OffsetCorner::mitre) {
                if (1 / std::cos(turn / 2) <= corners.longest_mitre()) {
                    wedge.push_back(around(turn / 2, 1 / std::cos(turn / 2)));
                } else {
                    wedge.push_back(around(turn / 4, 1 / std::cos(turn / 4)));
                    wedge.push_back(around(turn * 3 / 4, 1 / std::cos(turn / 4)));
                }
            } else if (corners.shape == OffsetCorner::round) {
                for (int k = 1; k < 60; ++k)
                    wedge.push_back(around(turn * k / 60, 1));
            }
            wedge.push_back(around(turn, 1));
            add(wedge);
        }
    }
    return layer_of(rings);
}

} // namespace lamella::test
