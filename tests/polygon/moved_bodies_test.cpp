#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/fill.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/moved_bodies.hpp"
#include "polygon/moved_rings.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace lamella::moved_bodies_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;

Point2 polar(double radius, double angle) {
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Kites side by side that meet in one point.
std::vector<Contour> petals(Random& random) {
    std::vector<Contour> rings;
    const double step = random.real(0.1, 1.5);
    for (double angle = random.real(0, 1); angle < 2 * std::numbers::pi - step; angle += step) {
        const double half = random.real(0.001, 0.49) * step;
        const double waist = random.real(1, 9);
        rings.push_back({{0, 0}, polar(waist, angle - half), polar(10, angle), polar(waist, angle + half)});
    }
    return rings;
}

/// Kites around one another that share one end, every other one a hole.
std::vector<Contour> kites(Random& random) {
    std::vector<Contour> rings;
    const double side = random.integer(0, 1) == 0 ? 1 : -1;
    double size = 10;
    for (std::int64_t i = random.integer(2, 12); i > 0; --i) {
        const double r = side * size;
        const double h = side * size * size / 10;
        rings.push_back({{0, 0}, {r, -h}, {2 * r, 0}, {r, h}});
        if (rings.size() % 2 == 0)
            std::reverse(rings.back().begin(), rings.back().end());
        size *= random.real(0.6, 0.99);
    }
    return rings;
}

/// A body with a notch, and a thin bar in it, over which its strips reach into the body.
std::vector<Contour> bar_in_a_notch(Random& random) {
    const double half = random.real(0.3, 1.2);
    const double y = random.real(0.01, 0.2);
    const double x = 0.9 * y * half;
    const double top = y + random.real(0.01, 0.1);
    return {{{-9, -9}, {9, -9}, {9, 5}, {5 * half, 5}, {0, 0}, {-5 * half, 5}, {-9, 5}},
            {{-x, y}, {x, y}, {x, top}, {-x, top}}};
}

TEST(MovedBodies, UnitedByHalvesAreThoseUnitedAtOnce) {
    Random random(91);
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        SCOPED_TRACE(round);
        const std::vector<Contour> rings = round % 3 == 0   ? petals(random)
                                           : round % 3 == 1 ? kites(random)
                                                            : bar_in_a_notch(random);
        const Layer layer = fill(normal_form(layer_of(rings)), FillRule::positive).layer;
        const double distance = random.real(0.01, 1.5) * (random.integer(0, 1) == 0 ? 1 : -1);
        const OffsetCorners corners{.shape = static_cast<OffsetCorner>(random.integer(0, 2)),
                                    .arc_tolerance_mm = 0.01};
        const std::vector<bool> none(layer.rings, false);
        const Layer moved = moved_rings(layer, {&distance, 1}, corners, {&none, 1}, {}).front();
        const Layer united = united_by_halves(moved, polygons(nesting(layer)), distance, {});
        const double expected = test::winding_area(moved, [](int winding) { return winding > 0; });
        ASSERT_NEAR(measure(united).area_mm2, expected, 1e-7) << distance;
        ASSERT_EQ(find_crossings(united).count, 0U);
        ASSERT_FALSE(fill(united, FillRule::positive).changed());
    }
}

} // namespace
} // namespace lamella::moved_bodies_cases
