#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/moved_rings.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/segment_distance.hpp"
#include "polygon/swept.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace lamella::moved_rings_cases {
namespace {

using test::layer_of;
using test::Random;
using test::rectangle;

constexpr std::array<OffsetCorners, 3> all_corners{OffsetCorners{},
                                                   OffsetCorners{.shape = OffsetCorner::bevel},
                                                   OffsetCorners{.shape = OffsetCorner::round}};

Layer moved(const Layer& layer, double distance, const OffsetCorners& corners) {
    const std::array distances{distance};
    const std::array gone{std::vector<bool>(layer.rings, false)};
    return moved_rings(layer, distances, corners, gone).front();
}

double distance_to(const Layer& layer, const Point2& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < layer.rings; ++r)
        for (std::size_t i = 0; i < layer.contour(r).size(); ++i)
            least = std::min(
                least, test::distance_from_segment(p, layer.contour(r)[i],
                                                   layer.contour(r)[(i + 1) % layer.contour(r).size()]));
    return least;
}

// The rings themselves, before any of them is united with others: loops cut off them may change no sign of a
// winding number.
TEST(MovedRings, WindAroundTheMaterialWithOrWithoutStripsAndWedges) {
    Random random(331);
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        Layer layer = test::random_material(random, round % 2 == 0);
        if (round % 5 == 0)
            layer = test::in_pieces(layer, random);
        if (test::has_walls(layer))
            continue;
        const OffsetCorners& corners = all_corners[static_cast<std::size_t>(round) % 3];
        const double distance = random.real(0.05, 3) * (random.integer(0, 1) == 0 ? 1 : -1);
        const double area =
            test::winding_area(moved(layer, distance, corners), [](int winding) { return winding > 0; });
        const double expected =
            test::winding_area(layer, test::swept(layer, distance, corners), [&](int material, int strips) {
                return distance > 0 ? material > 0 || strips > 0 : material > 0 && strips == 0;
            });
        const double tolerance =
            corners.shape == OffsetCorner::round ? 0.004 * measure(layer).perimeter_mm + 0.05 : 1e-6;
        ASSERT_NEAR(area, expected, tolerance) << round << ' ' << distance;
    }
}

TEST(MovedRings, CoverAllPointsThatAreSurelySwept) {
    Random random(332);
    std::size_t swept = 0;
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const Layer layer = test::random_material(random, round % 2 == 0);
        const OffsetCorners& corners = all_corners[static_cast<std::size_t>(round) % 3];
        const double distance = random.real(0.05, 3) * (random.integer(0, 1) == 0 ? 1 : -1);
        const Layer result = moved(layer, distance, corners);
        const double surely = surely_swept(distance, corners);
        EXPECT_LE(surely, std::abs(distance));
        for (int i = 0; i < 100; ++i) {
            const Point2 p{random.real(-10, 30), random.real(-10, 30)};
            const double away = distance_to(layer, p);
            const bool inside = test::plain_winding(layer, p) > 0;
            const bool after = test::plain_winding(result, p) > 0;
            if (away < surely - 1e-9) {
                EXPECT_EQ(after, distance > 0) << round;
                ++swept;
            } else if (inside == (distance > 0)) {
                EXPECT_EQ(after, inside) << round << ": growing takes nothing away, shrinking adds nothing";
            } else if (away > corners.longest_mitre() * std::abs(distance) + 1e-9) {
                EXPECT_EQ(after, inside) << round << ": nothing reaches so far";
            }
        }
    }
    EXPECT_GT(swept, test::slowed ? 0U : 1000U);
}

TEST(MovedRings, OfSeveralDistancesAreThoseOfEach) {
    Random random(333);
    const std::array distances{0.5, -0.25, 2.0};
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        const Layer layer = test::random_material(random, false);
        for (const OffsetCorners& corners : all_corners) {
            const std::array gone{std::vector<bool>(layer.rings, false),
                                  std::vector<bool>(layer.rings, false),
                                  std::vector<bool>(layer.rings, false)};
            const std::vector<Layer> together = moved_rings(layer, distances, corners, gone);
            ASSERT_EQ(together.size(), distances.size());
            for (std::size_t k = 0; k < distances.size(); ++k)
                EXPECT_EQ(test::contours(together[k]), test::contours(moved(layer, distances[k], corners)));
        }
    }
}

TEST(MovedRings, KeepTheirOrderAndHaveNoRepeatedPoints) {
    Random random(334);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        Layer layer = layer_of(test::tangled_rings(random, true), {{{0, 0}, {1, 1}}});
        layer.index = 5;
        layer.z = 0.25;
        const Layer result =
            moved(layer, random.real(-3, 3), all_corners[static_cast<std::size_t>(round) % 3]);
        EXPECT_EQ(result.rings, layer.rings) << "one for each ring";
        EXPECT_EQ(result.contours(), layer.rings) << "and no chains";
        EXPECT_EQ(result.offsets.back(), result.points.size());
        EXPECT_EQ(result.index, 5U);
        EXPECT_EQ(result.z, 0.25);
        for (std::size_t r = 0; r < result.rings; ++r) {
            const auto ring = result.contour(r);
            EXPECT_NE(ring.size(), 1U);
            EXPECT_NE(ring.size(), 2U);
            for (std::size_t i = 0; i < ring.size(); ++i)
                EXPECT_NE(ring[i], ring[(i + 1) % ring.size()]) << round;
        }
    }
}

TEST(MovedRings, ThatAreGoneAreEmpty) {
    const Layer layer = layer_of({rectangle(0, 0, 4, 4), rectangle(9, 0, 10, 1)});
    const std::array distances{-1.0, 1.0};
    const std::array gone{std::vector<bool>{false, true}, std::vector<bool>{false, false}};
    const std::vector<Layer> result = moved_rings(layer, distances, {}, gone);
    EXPECT_EQ(test::contours(normal_form(result[0])).back(), rectangle(1, 1, 3, 3));
    EXPECT_TRUE(result[0].contour(1).empty());
    EXPECT_EQ(result[1].contour(1).size(), 4U);
}

TEST(MovedRings, ScaleWithTheirLayer) {
    Random random(335);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        const Layer layer = layer_of({test::star(random, {0, 0}, 4)});
        std::vector<Point2> points;
        for (const Point2& p : layer.points)
            points.push_back({1024 * p.x, 1024 * p.y});
        Layer large = layer;
        large.points = PointArray(points);
        const Layer small = moved(layer, 0.375, {});
        const Layer same = moved(large, 1024 * 0.375, {});
        ASSERT_EQ(small.points.size(), same.points.size()) << round;
        for (std::size_t i = 0; i < small.points.size(); ++i)
            EXPECT_EQ((Point2{1024 * small.points[i].x, 1024 * small.points[i].y}), same.points[i]) << round;
    }
}

} // namespace
} // namespace lamella::moved_rings_cases
