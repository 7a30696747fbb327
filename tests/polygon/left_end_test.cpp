#include "lamella/contour/measure.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/left_end.hpp"
#include "polygon/plain_rings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

namespace lamella::left_end_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::reversed;

LeftEnd of(const Contour& ring) {
    const Layer layer = layer_of({ring});
    return left_end(layer, MonotoneChains(layer), 0);
}

TEST(LeftEnd, HasTheLowestOfTheEdgesThatBeginFarthestLeft) {
    Random random(281);
    for (int round = 0; round < test::rounds_within_reason(2000); ++round) {
        const Contour ring = test::tangled_rings(random, true).front();
        const LeftEnd end = of(ring);
        double left = ring[0].x;
        for (const Point2& p : ring)
            left = std::min(left, p.x);
        EXPECT_EQ(end.smallest, *std::min_element(ring.begin(), ring.end())) << round;
        std::optional<Segment> lowest;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Segment edge = segment_between(ring[i], ring[(i + 1) % ring.size()]);
            if (edge.lo.x != left || edge.hi.x == left)
                continue;
            const auto rise_by = [](const Segment& s, const Segment& t) {
                return (s.hi.y - s.lo.y) * (t.hi.x - t.lo.x);
            };
            if (!lowest || edge.lo.y < lowest->lo.y ||
                (edge.lo.y == lowest->lo.y && rise_by(edge, *lowest) < rise_by(*lowest, edge)))
                lowest = edge;
        }
        if (!lowest) {
            EXPECT_TRUE(end.flat) << round;
            continue;
        }
        EXPECT_EQ(end.line.lo, lowest->lo) << round;
        EXPECT_EQ(side(*lowest, end.line.hi), 0) << round;
        const bool flat =
            std::all_of(ring.begin(), ring.end(), [&](const Point2& p) { return side(*lowest, p) == 0; });
        EXPECT_EQ(end.flat, flat) << round;
    }
}

TEST(LeftEnd, KnowsTheDirectionOfRingsThatDoNotCrossThemselves) {
    Random random(282);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        const Contour ring = test::star(random, {random.real(-5, 5), random.real(-5, 5)}, 3);
        EXPECT_TRUE(of(ring).rightwards) << round;
        EXPECT_FALSE(of(reversed(ring)).rightwards) << round;
    }
}

TEST(LeftEnd, OfAFoldHasTheDirectionOfTheRest) {
    const Contour ring{{0, 0}, {2, 0}, {0, 0}, {5, 0}, {5, 5}};
    EXPECT_TRUE(of(ring).rightwards);
    EXPECT_FALSE(of(reversed(ring)).rightwards);
    EXPECT_FALSE(of(ring).flat);
    EXPECT_TRUE(of({{0, 0}, {2, 2}, {1, 1}}).flat);
    EXPECT_TRUE(of({{3, 0}, {3, 7}, {3, 5}}).flat);
    EXPECT_TRUE(of({{3, 0}}).flat);
}

} // namespace
} // namespace lamella::left_end_cases
