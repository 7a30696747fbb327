#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/arrangement.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/segment_distance.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella::arrangement_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

/// Rings on their grid.
struct Arranged {
    explicit Arranged(const std::vector<RingWithWinding>& rings, const Layer& layer)
        : grid(layer.points.span()), result(arranged(rings, {}, grid)) {}

    ClippingGrid grid;
    Arrangement result;
};

std::vector<RingWithWinding> rings_of(const Layer& layer) {
    std::vector<RingWithWinding> rings;
    for (std::size_t i = 0; i < layer.rings; ++i)
        rings.push_back({layer.contour(i), {1, 0}, 1});
    return rings;
}

/// The segments of a side, from left to right.
std::vector<Segment> segments(const Arrangement& arrangement, const Side& side) {
    std::vector<Segment> result;
    Point2 from = side.line.lo;
    for (const Corner& corner : arrangement.corners_of(side)) {
        result.push_back({from, corner.position});
        from = corner.position;
    }
    result.push_back({from, side.line.hi});
    return result;
}

TEST(Arrangement, HasSidesThatMeetOnlyAtTheirEnds) {
    Random random(201);
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const Layer layer = layer_of(test::tangled_rings(random, round % 2 == 0));
        const Arranged all(rings_of(layer), layer);
        std::vector<Segment> lines;
        for (const Side& side : all.result.sides)
            for (const Segment& s : segments(all.result, side))
                lines.push_back(s);
        for (const Segment& s : lines) {
            ASSERT_LT(s.lo, s.hi) << round;
            for (const Segment& t : lines) {
                if (&s == &t)
                    continue;
                ASSERT_FALSE(cross(s, t)) << round;
                ASSERT_FALSE(s.lo == t.lo && s.hi == t.hi) << round;
                for (const Point2& p : {t.lo, t.hi})
                    ASSERT_FALSE(s.lo < p && p < s.hi && side(s, p) == 0) << round;
            }
        }
    }
}

TEST(Arrangement, HasTheWindingNumbersOfPointsOnBothSides) {
    Random random(202);
    std::size_t compared = 0;
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const Layer layer = layer_of(test::tangled_rings(random, round % 2 == 0));
        std::vector<RingWithWinding> rings = rings_of(layer);
        for (RingWithWinding& ring : rings) {
            ring.turn = random.integer(0, 1) == 0 ? Windings{1, 0} : Windings{0, 1};
            ring.left = random.integer(-1, 1);
        }
        const Arranged all(rings, layer);
        const auto count_at = [&](const Point2& p) {
            SideCount count;
            for (const RingWithWinding& ring : rings)
                count += test::plain_winding(ring.points, p) * SideCount{ring.turn, ring.left};
            return count;
        };
        // A point is decided if no side comes close to it except those that it is tested beside.
        const auto undecided = [&](const Point2& p) {
            for (std::size_t r = 0; r < layer.rings; ++r)
                for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
                    const double away = test::distance_from_segment(
                        p, layer.contour(r)[i], layer.contour(r)[(i + 1) % layer.contour(r).size()]);
                    if (away > 1e-8 && away < 1e-5)
                        return true;
                }
            return false;
        };
        for (const Side& side : all.result.sides)
            for (const Segment& s : segments(all.result, side)) {
                const Point2 a = all.grid.point(s.lo);
                const Point2 b = all.grid.point(s.hi);
                const double length = std::hypot(b.x - a.x, b.y - a.y);
                const Point2 middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
                if (length < 1e-3 || undecided(middle))
                    continue;
                const Point2 left{-(b.y - a.y) / length * 1e-6, (b.x - a.x) / length * 1e-6};
                EXPECT_EQ(count_at({middle.x + left.x, middle.y + left.y}), side.above()) << round;
                EXPECT_EQ(count_at({middle.x - left.x, middle.y - left.y}), side.below) << round;
                ++compared;
            }
    }
    EXPECT_GT(compared, test::slowed ? 0U : 1000U);
}

TEST(Arrangement, AddsUpToTheAreaOfEachRule) {
    Random random(203);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        const Layer layer = layer_of(test::tangled_rings(random, round % 2 == 0));
        const Arranged all(rings_of(layer), layer);
        for (const FillRule rule : {FillRule::positive, FillRule::nonzero, FillRule::evenodd}) {
            const Material material(rule);
            double area = 0; // under its upper sides, less that under its lower ones
            for (const Side& side : all.result.sides) {
                const int sign = static_cast<int>(material(side.below.windings)) -
                                 static_cast<int>(material(side.above().windings));
                for (const Segment& s : segments(all.result, side)) {
                    const Point2 a = all.grid.point(s.lo);
                    const Point2 b = all.grid.point(s.hi);
                    area += sign * (b.x - a.x) * (a.y + b.y) / 2;
                }
            }
            EXPECT_NEAR(area,
                        test::winding_area(layer,
                                           [&](int w) {
                                               return material(Windings{w, 0});
                                           }),
                        1e-6)
                << round;
        }
    }
}

TEST(Arrangement, CountsWhatIsAroundAllRings) {
    const Layer layer = layer_of({rectangle(0, 0, 4, 4)});
    const ClippingGrid grid(layer.points.span());
    const Arrangement within = arranged(rings_of(layer), {2, -1}, grid);
    for (const Side& side : within.sides) {
        EXPECT_TRUE(side.below.windings == (Windings{2, -1}) || side.above().windings == (Windings{2, -1}));
        EXPECT_TRUE(side.below.windings == (Windings{3, -1}) || side.above().windings == (Windings{3, -1}));
    }
}

TEST(Arrangement, ReportsWallsAndCrossings) {
    const auto of = [](const std::vector<Contour>& rings) {
        const Layer layer = layer_of(rings);
        return Arranged(rings_of(layer), layer).result;
    };
    const Arrangement apart = of({rectangle(0, 0, 4, 4), rectangle(6, 0, 9, 4)});
    EXPECT_FALSE(apart.walls || apart.crossed);
    const Arrangement beside = of({rectangle(0, 0, 4, 4), rectangle(4, 1, 9, 3)});
    EXPECT_TRUE(beside.walls);
    EXPECT_FALSE(beside.crossed);
    const Arrangement through = of({rectangle(0, 0, 4, 4), rectangle(2, 2, 9, 9)});
    EXPECT_TRUE(through.crossed);
    EXPECT_FALSE(through.walls);
}

TEST(Arrangement, IsBoundedByRingsThatAreTheBoundary) {
    const auto bounded = [](const std::vector<Contour>& rings) {
        const Layer layer = layer_of(rings);
        return Arranged(rings_of(layer), layer).result.bounded_by_all(Material(FillRule::positive));
    };
    EXPECT_TRUE(bounded({rectangle(0, 0, 9, 9), reversed(rectangle(0, 2, 7, 7))}));
    EXPECT_TRUE(bounded({rectangle(0, 0, 4, 4), rectangle(4, 0, 9, 4)}));
    EXPECT_FALSE(bounded({rectangle(0, 0, 9, 9), rectangle(0, 2, 7, 7)}));
    EXPECT_FALSE(bounded({reversed(rectangle(0, 0, 9, 9))}));
}

TEST(Arrangement, RefusesMoreCrossingsThanItsLimit) {
    std::vector<Contour> rings;
    for (int i = 0; i < 20; ++i) {
        rings.push_back(rectangle(3 * i, 0, 3 * i + 1, 100));
        rings.push_back(rectangle(0, 3 * i, 100, 3 * i + 1));
    }
    const Layer layer = layer_of(rings);
    const ClippingGrid grid(layer.points.span());
    test::expect_error(ErrorKind::limit, {"cross"}, [&] {
        static_cast<void>(arranged(rings_of(layer), {}, grid, {}, {100, 0}));
    });
    EXPECT_FALSE(arranged(rings_of(layer), {}, grid, {}, {1600, 0}).sides.empty());
}

} // namespace
} // namespace lamella::arrangement_cases
