#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "polygon/orientation.hpp"
#include "polygon/swept.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace lamella::offset_cases {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::regular_polygon;
using test::reversed;

constexpr OffsetCorners mitred{};
constexpr OffsetCorners bevelled{.shape = OffsetCorner::bevel};
constexpr OffsetCorners rounded{.shape = OffsetCorner::round};

double area(const Layer& layer) {
    return measure(layer).area_mm2;
}

/// The distance of a point to the nearest side of a layer.
double distance_to(const Layer& layer, const Point2& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < layer.rings; ++r)
        for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
            const Point2& a = layer.contour(r)[i];
            const Point2& b = layer.contour(r)[(i + 1) % layer.contour(r).size()];
            const double dx = b.x - a.x;
            const double dy = b.y - a.y;
            const double t =
                std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
            least = std::min(least, std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy));
        }
    return least;
}

/// The number of times the rings of a layer run around a point.
int winding(const Layer& layer, const Point2& p) {
    int winding = 0;
    for (std::size_t r = 0; r < layer.rings; ++r)
        for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
            const Point2& a = layer.contour(r)[i];
            const Point2& b = layer.contour(r)[(i + 1) % layer.contour(r).size()];
            if ((a.y <= p.y) != (b.y <= p.y) && orientation(a, b, p) == (a.y < b.y ? 1 : -1))
                winding += a.y < b.y ? 1 : -1;
        }
    return winding;
}

TEST(Offset, OfNothingIsTheLayerItself) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4)}));
    EXPECT_EQ(offset(layer, 0).points.data(), layer.points.data());
    EXPECT_EQ(offset(Layer{}, 1).contours(), 0U);
}

TEST(Offset, MovesTheSidesOfBodiesOutwardsAndOfHolesInwards) {
    const Layer frame = normal_form(layer_of({rectangle(0, 0, 10, 10), reversed(rectangle(3, 3, 7, 7))}));
    EXPECT_NEAR(area(offset(frame, 0.5)), 121 - 9, 1e-12);
    EXPECT_NEAR(area(offset(frame, -0.5)), 81 - 25, 1e-12);
    EXPECT_NEAR(area(offset(frame, 2)), 196, 1e-6); // the hole is gone
    EXPECT_NEAR(area(offset(frame, 5)), 400, 1e-6); // its sides have passed one another
    EXPECT_EQ(offset(frame, -1.5).rings, 0U);
    EXPECT_EQ(offset(frame, -20).rings, 0U);
}

TEST(Offset, OfRegularPolygonsIsThatOfTheirCircles) {
    for (const int n : {4, 6, 12, 100, 1000})
        for (const double distance : {-3.0, -0.1, 0.1, 5.0}) {
            const Layer grown = offset(normal_form(layer_of({regular_polygon(n, 10)})), distance);
            // The inscribed circle grows by the distance, and the corners stay corners.
            const double inner = 10 * std::cos(std::numbers::pi / n) + distance;
            EXPECT_NEAR(area(grown), n * inner * inner * std::tan(std::numbers::pi / n), 1e-9) << n;
            EXPECT_EQ(grown.points.size(), static_cast<std::size_t>(n));
        }
}

TEST(Offset, CutsSharpCornersOff) {
    const Layer needle = normal_form(layer_of({{{0, 0}, {100, -1}, {100, 1}}}));
    for (const Point2& p : offset(needle, 1).points)
        EXPECT_GE(p.x, -1.000000001);
    const double farther = offset(needle, 1, {.corners = {.mitre_limit = 1000}}).points[0].x;
    EXPECT_NEAR(farther, -std::sqrt(10001), 1e-6);
}

// Of an equilateral triangle all mitres are exactly as long as the limit allows, but for rounding.
TEST(Offset, MitresCornersAtTheLimitWhateverTheirRounding) {
    constexpr double third = 2 * std::numbers::pi / 3;
    for (const double size : {0.7, 5.0, 80.0})
        for (int k = 0; k < 400; ++k) {
            const double angle = 0.0357 * k;
            Contour triangle;
            Contour in_single_precision; // as a mesh in STL has them
            for (int i = 0; i < 3; ++i) {
                const Point2 p{120 + size * std::cos(angle + third * i),
                               90 + size * std::sin(angle + third * i)};
                triangle.push_back(p);
                in_single_precision.push_back({static_cast<float>(p.x), static_cast<float>(p.y)});
            }
            for (const Contour& ring : {triangle, in_single_precision}) {
                SCOPED_TRACE(angle);
                EXPECT_EQ(offset(normal_form(layer_of({ring})), 0.5).points.size(), 3U);
                EXPECT_EQ(offset(normal_form(layer_of({ring})), 0.5, {.corners = {.mitre_limit = 1.99}})
                              .points.size(),
                          6U);
            }
        }
}

TEST(Offset, KeepsChordsOfRoundCornersWithinTheirToleranceAtAnyDistance) {
    const Layer square = normal_form(layer_of({rectangle(0, 0, 10, 10)}));
    for (const double distance : {0.5, 3.0, 100.0, 1e4, 1e6}) {
        const Layer grown = offset(square, distance, {.corners = rounded});
        ASSERT_EQ(grown.rings, 1U);
        const auto ring = grown.contour(0);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& a = ring[i];
            const Point2& b = ring[(i + 1) % ring.size()];
            for (const Point2& p : {a, Point2{(a.x + b.x) / 2, (a.y + b.y) / 2}})
                ASSERT_NEAR(distance_to(square, p), distance, 0.001 * (1 + 1e-6)) << distance;
        }
    }
}

TEST(Offset, IsRefusedWhereItsPointsWouldTakeMoreMemoryThanThereIsForThem) {
    const Layer square = normal_form(layer_of({rectangle(0, 0, 10, 10)}));
    test::expect_error(ErrorKind::limit, {"points of an offset", "`max_memory`"}, [&] {
        static_cast<void>(offset(square, 1e6, {.corners = rounded, .limits = {.memory = 1 << 20}}));
    });
}

TEST(Offset, JoinsSidesAsWished) {
    const Layer square = normal_form(layer_of({rectangle(0, 0, 10, 10)}));
    EXPECT_NEAR(area(offset(square, 1, {.corners = bevelled})), 100 + 40 + 4 * 0.5, 1e-12);
    EXPECT_EQ(offset(square, 1, {.corners = bevelled}).points.size(), 8U);
    const double circle = std::numbers::pi;
    EXPECT_NEAR(area(offset(square, 1, {.corners = rounded})), 140 + circle, 0.005);
    EXPECT_LT(area(offset(square, 1, {.corners = rounded})), 140 + circle);
    EXPECT_NEAR(
        area(offset(square, 1, {.corners = {.shape = OffsetCorner::round, .arc_tolerance_mm = 1e-6}})),
        140 + circle, 1e-3);
    for (const OffsetCorners& corners : {mitred, bevelled, rounded})
        EXPECT_NEAR(area(offset(square, -1, {.corners = corners})), 64, 1e-12); // nothing parts
    const Layer hole = normal_form(layer_of({rectangle(-9, -9, 19, 19), reversed(rectangle(0, 0, 10, 10))}));
    EXPECT_NEAR(area(offset(hole, -1, {.corners = rounded})), 26 * 26 - 140 - circle, 0.005);
}

TEST(Offset, HasNoPointTwiceInARow) {
    // The inner corners meet where the sides of the notch shrink to nothing.
    const Layer notched = normal_form(layer_of({{{0, 1}, {1, 1}, {1, 0}, {2, 0}, {2, 3}, {0, 3}}}));
    for (const OffsetCorners& corners : {mitred, bevelled, rounded})
        for (const double distance : {1.0, -1.0, 0.5}) {
            const Layer moved = offset(notched, distance, {.corners = corners});
            for (std::size_t i = 0; i < moved.contours(); ++i) {
                const auto ring = moved.contour(i);
                for (std::size_t k = 0; k < ring.size(); ++k)
                    EXPECT_FALSE(ring[k] == ring[(k + 1) % ring.size()]) << distance;
            }
        }
}

TEST(Offset, UnitesWhatMeetsAndOverlaps) {
    const Layer apart = normal_form(layer_of({rectangle(0, 0, 4, 4), rectangle(5, 0, 9, 4)}));
    EXPECT_EQ(offset(apart, 0.25).rings, 2U);
    EXPECT_EQ(offset(apart, 0.5).rings, 1U);
    EXPECT_EQ(offset(apart, 0.75).rings, 1U);
    const Layer crossing = normal_form(layer_of({rectangle(0, 0, 4, 4), rectangle(2, 0, 6, 4)}));
    EXPECT_NEAR(area(offset(crossing, 1)), 8 * 6, 1e-6);
    EXPECT_NEAR(area(offset(crossing, -1)), 4 * 2, 1e-6);
    EXPECT_EQ(find_crossings(offset(crossing, 1)).count, 0U);
}

TEST(Offset, MakesNoWallsWhereAHoleRunsAlongItsBody) {
    const Layer notched = layer_of({rectangle(6, 5, 14, 6), reversed(rectangle(6, 5, 8, 6))});
    const Layer rest = layer_of({rectangle(8, 5, 14, 6)});
    for (const double distance : {0.05, 2.0, -0.2}) {
        const Layer moved = offset(notched, distance);
        EXPECT_EQ(moved.rings, 1U);
        EXPECT_NEAR(measure(moved).area_mm2, measure(offset(rest, distance)).area_mm2, 1e-8);
    }
    const Layer back_to_back = layer_of({rectangle(0, 0, 2, 2), rectangle(2, 0, 4, 2)});
    EXPECT_NEAR(area(offset(back_to_back, -0.5)), 3, 1e-8);
}

// What a direction says about a turn is rounding there.
TEST(Offset, OfNeedlesAsWideAsRoundingIsThatOfALine) {
    EXPECT_EQ(offset(layer_of({{{17.1, 25.9}, {35.9, 54.1}, {20.9, 31.6}}}), -0.05).rings, 0U);
    Random random(87);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        const Point2 a{random.real(-9, 9), random.real(-9, 9)};
        const Point2 b{random.real(-9, 9), random.real(-9, 9)};
        const double t = random.real(0, 1);
        const Point2 c{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        for (const Contour& ring : {Contour{a, b, c}, Contour{a, c, b}}) {
            const Layer needle = normal_form(layer_of({ring}));
            EXPECT_EQ(offset(needle, -0.05).rings, 0U) << round;
            if (orientation(ring[0], ring[1], ring[2]) > 0) {
                EXPECT_NEAR(area(offset(needle, 1, {.corners = rounded})), 2 * length + std::numbers::pi,
                            0.01)
                    << round;
            }
        }
    }
}

TEST(Offset, OfSlitsAsWideAsRoundingIsThatOfWiderOnes) {
    Random random(88);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        const double angle = random.real(0, 6);
        const double away = random.real(0, 100);
        const auto turned = [&](double x, double y) {
            return Point2{away + x * std::cos(angle) - y * std::sin(angle),
                          x * std::sin(angle) + y * std::cos(angle)};
        };
        const double foot = random.real(2, 4);
        const Point2 tip = turned(foot + random.real(-1, 1), random.real(0.5, 4));
        const Point2 in = turned(foot, 0);
        const auto slit = [&](const Point2& out) {
            return layer_of({{turned(0, 0), in, tip, out, turned(6, 0), turned(6, 6), turned(0, 6)}});
        };
        const auto beside = [&](double x) {
            return std::nextafter(x, x + static_cast<double>(random.integer(-1, 1)));
        };
        Point2 out = in;
        while (orientation(in, tip, out) >= 0) // to the right of the way in
            out = {beside(in.x), beside(in.y)};
        for (const double distance : {-0.4, 0.4})
            EXPECT_NEAR(area(offset(slit(out), distance)),
                        area(offset(slit(turned(foot + 1e-7, 0)), distance)), 1e-5)
                << round;
    }
}

TEST(Offset, KeepsOpenChains) {
    const Contour chain{{1, 1}, {20, 3}};
    const Layer grown = offset(normal_form(layer_of({rectangle(0, 0, 4, 4)}, {chain})), 1);
    ASSERT_EQ(grown.open_chains(), 1U);
    EXPECT_EQ(Contour(grown.contour(1).begin(), grown.contour(1).end()), chain);
    EXPECT_TRUE(in_normal_form(grown));
}

TEST(Offset, ByWhatIsNoDistanceIsRefused) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4)}));
    EXPECT_THROW(static_cast<void>(offset(layer, std::numeric_limits<double>::infinity())), Error);
    EXPECT_THROW(static_cast<void>(offset(layer, std::nan(""))), Error);
    EXPECT_THROW(static_cast<void>(offset(layer, 1, {.corners = {.mitre_limit = 0.5}})), Error);
    EXPECT_THROW(static_cast<void>(
                     offset(layer, 1, {.corners = {.shape = OffsetCorner::round, .arc_tolerance_mm = 0}})),
                 Error);
}

TEST(Offset, OfManySidesByFarMoreThanTheirBodyWithoutLookingAtAllPairs) {
    LAMELLA_SKIP_IF_SLOWED();
    const Layer disc = normal_form(layer_of({regular_polygon(100000, 10)}));
    const Layer pierced =
        normal_form(layer_of({rectangle(-20, -20, 20, 20), reversed(regular_polygon(100000, 10))}));
    for (const OffsetCorners& corners : {mitred, rounded}) {
        const CountedOffset gone = counted_offset(disc, -100, {.corners = corners});
        EXPECT_EQ(gone.layer.contours(), 0U);
        EXPECT_EQ(gone.rings_vanished, 1U);
        const CountedOffset closed = counted_offset(pierced, 100, {.corners = corners});
        EXPECT_EQ(closed.layer.rings, 1U);
        EXPECT_EQ(closed.rings_vanished, 1U);
    }
}

TEST(Offset, CountsRingsThatNothingIsLeftOf) {
    const Layer layer =
        layer_of({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 2, 2)), reversed(rectangle(4, 4, 8, 8)),
                  rectangle(5, 5, 6, 6), rectangle(20, 0, 30, 1)});
    const auto gone = [&](double distance) {
        const CountedOffset moved = counted_offset(layer, distance, {.corners = mitred});
        EXPECT_TRUE(same_contours(moved.layer, offset(layer, distance, {.corners = mitred})));
        return moved.rings_vanished;
    };
    EXPECT_EQ(gone(-0.1), 0U);
    EXPECT_EQ(gone(-0.6), 2U); // the small body and the flat one
    EXPECT_EQ(gone(-2), 5U);
    EXPECT_EQ(gone(0.4), 0U);
    EXPECT_EQ(gone(0.6), 1U);
    EXPECT_EQ(gone(2.5), 2U);
    EXPECT_EQ(gone(0), 0U);
}

TEST(Offset, IsTheMaterialWithOrWithoutStripsAndWedges) {
    Random random(81);
    for (int round = 0; round < test::rounds_within_reason(3000); ++round) {
        SCOPED_TRACE(round);
        Layer layer = test::random_material(random, round % 2 == 0);
        if (round % 5 == 0)
            layer = test::in_pieces(layer, random);
        if (test::has_walls(layer))
            continue;
        const OffsetCorners corners = round % 3 == 0 ? mitred : round % 3 == 1 ? bevelled : rounded;
        const double distance = random.real(0.05, 3) * (random.integer(0, 1) == 0 ? 1 : -1);
        const Layer moved = offset(layer, distance, {.corners = corners});
        const double expected =
            test::winding_area(layer, test::swept(layer, distance, corners), [&](int material, int strips) {
                return distance > 0 ? material > 0 || strips > 0 : material > 0 && strips == 0;
            });
        const double tolerance =
            corners.shape == OffsetCorner::round ? 0.004 * measure(layer).perimeter_mm + 0.05 : 1e-6;
        ASSERT_NEAR(area(moved), expected, tolerance) << distance;
        ASSERT_TRUE(in_normal_form(moved));
        ASSERT_EQ(find_crossings(moved).count, 0U);
        ASSERT_FALSE(fill(moved, FillRule::positive).changed());
    }
}

/// A section of a strut whose faces are two triangles each, nearly in one plane: beside each corner of its
/// polygon another one, by which it turns a little more, or back.
Layer strut(Random& random) {
    const std::int64_t faces = random.integer(5, 40);
    const double radius = random.real(0.5, 3);
    const double where = random.real(0.001, 0.2);
    Contour ring;
    const auto corner = [&](std::int64_t i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(faces);
        return Point2{5 + radius * std::cos(angle), 5 + 1.1 * radius * std::sin(angle)};
    };
    for (std::int64_t i = 0; i < faces; ++i) {
        const Point2 a = corner(i);
        const Point2 b = corner(i + 1);
        const double off = 0.02 * where * std::sin(0.7 * static_cast<double>(i));
        ring.push_back(a);
        ring.push_back(
            {a.x + where * (b.x - a.x) - off * (b.y - a.y), a.y + where * (b.y - a.y) + off * (b.x - a.x)});
    }
    return normal_form(layer_of({random.integer(0, 3) == 0 ? reversed(ring) : ring}));
}

TEST(Offset, OfStrutsWithAShortSideAtEachCorner) {
    Random random(85);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        SCOPED_TRACE(round);
        Layer layer = strut(random);
        if (ring_area(layer.contour(0)) < 0) // a hole
            layer = normal_form(layer_of({test::contours(layer).front(), rectangle(0, 0, 10, 10)}));
        const double distance = random.real(0.01, 0.6) * (random.integer(0, 1) == 0 ? 1 : -1);
        const Layer moved = offset(layer, distance, {.corners = mitred});
        const double expected =
            test::winding_area(layer, test::swept(layer, distance, mitred), [&](int material, int strips) {
                return distance > 0 ? material > 0 || strips > 0 : material > 0 && strips == 0;
            });
        ASSERT_NEAR(area(moved), expected, 1e-6) << distance;
        ASSERT_EQ(find_crossings(moved).count, 0U);
    }
}

OffsetCorners random_corners(Random& random) {
    const std::int64_t shape = random.integer(0, 2);
    return shape == 0 ? mitred : shape == 1 ? bevelled : rounded;
}

/// What of a layer's material another one has not.
double excess(const Layer& layer, const Layer& other) {
    return area(combine(layer, other, BooleanOperation::subtract));
}

TEST(Offset, GrowsWithItsDistance) {
    Random random(82);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        SCOPED_TRACE(round);
        const Layer layer = test::random_material(random, round % 2 == 0);
        const OffsetCorners corners = random_corners(random);
        const std::array<double, 5> distances{-1.1, -0.3, 0, 0.2, random.real(0.3, 4)};
        const std::vector<Layer> moved = offsets(layer, distances, {.corners = corners});
        for (std::size_t i = 0; i < moved.size(); ++i) {
            EXPECT_TRUE(same_contours(moved[i], offset(layer, distances[i], {.corners = corners})));
            if (i > 0 && corners.shape != OffsetCorner::bevel) { // a wider strip has a longer bevel
                EXPECT_NEAR(excess(moved[i - 1], moved[i]), 0, 1e-5);
            }
        }
    }
}

TEST(Offset, ShrunkThenGrownIsContained) {
    Random random(83);
    for (int round = 0; round < test::rounds_within_reason(100); ++round) {
        SCOPED_TRACE(round);
        const Layer layer = test::random_material(random, round % 2 == 0);
        const double distance = random.real(0.1, 2);
        const OffsetCorners fine{.shape = OffsetCorner::round, .arc_tolerance_mm = 1e-3};
        const double perimeter = measure(layer).perimeter_mm;
        EXPECT_NEAR(
            excess(offset(offset(layer, -distance, {.corners = fine}), distance, {.corners = fine}), layer),
            0, 1e-3 * perimeter);
        EXPECT_NEAR(
            excess(layer, offset(offset(layer, distance, {.corners = fine}), -distance, {.corners = fine})),
            0, 1e-3 * perimeter);
    }
}

TEST(Offset, WithRoundCornersHasItsContoursAtTheDistance) {
    Random random(84);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        SCOPED_TRACE(round);
        const Layer layer = test::random_material(random, round % 2 == 0);
        if (test::has_walls(layer))
            continue;
        const double distance = random.real(0.1, 2) * (round % 3 == 0 ? 1 : -1);
        for (const Point2& p : offset(layer, distance, {.corners = rounded}).points)
            ASSERT_NEAR(distance_to(layer, p), std::abs(distance), 0.0011);
        for (const Point2& p : offset(layer, distance).points) { // mitred: up to twice that
            ASSERT_GE(distance_to(layer, p), std::abs(distance) - 1e-6);
            ASSERT_LE(distance_to(layer, p), 2 * std::abs(distance) + 1e-6);
        }
    }
}

TEST(Offset, TakesAnyLayerThatFillTakes) {
    Random random(85);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        SCOPED_TRACE(round);
        std::vector<Contour> rings;
        for (std::int64_t c = random.integer(1, 6); c > 0; --c) {
            Contour ring;
            for (std::int64_t i = random.integer(0, 8); i > 0; --i)
                ring.push_back({std::round(random.real(0, 9)), std::round(random.real(0, 9))});
            rings.push_back(ring);
        }
        const Layer layer = layer_of(rings);
        for (const double distance : {-0.3, 0.4, 1.0, 1e-9, -1e-9, 1e6}) {
            const OffsetCorners corners = random_corners(random);
            const bool many_chords = corners.shape == OffsetCorner::round && distance == 1e6;
            const Layer moved = offset(layer, many_chords ? 1e3 : distance, {.corners = corners});
            ASSERT_TRUE(in_normal_form(moved));
            ASSERT_EQ(find_crossings(moved).count, 0U);
            ASSERT_FALSE(fill(moved, FillRule::positive).changed());
        }
    }
}

/// Kites side by side around one point, with half of the angle between them free.
std::vector<Contour> petals(int count) {
    std::vector<Contour> rings;
    const auto polar = [&](double radius, double step) {
        const double angle = 2 * std::numbers::pi * step / count;
        return Point2{radius * std::cos(angle), radius * std::sin(angle)};
    };
    for (int i = 0; i < count; ++i)
        rings.push_back({{0, 0}, polar(60, i - 0.25), polar(100, i), polar(60, i + 0.25)});
    return rings;
}

TEST(Offset, OfThousandsOfRingsThatMeetInAPointTakesNoMemoryForTheirCrossings) {
    // Their moved rings cross six million times.
    std::vector<Contour> rings = petals(1600);
    const Layer grown = offset(layer_of(rings), 0.1, {.corners = mitred, .limits = {.memory = 16 << 20}});
    EXPECT_EQ(grown.rings, 1U);
    EXPECT_FALSE(fill(grown, FillRule::positive).changed());
    const Layer petal = layer_of({rings.front()});
    Random random(87);
    for (int i = 0; i < 1000; ++i) {
        // The symmetry leaves half of a petal to be examined.
        const double angle = random.real(0, std::numbers::pi / 1600);
        const double radius = random.real(1, 101);
        const Point2 p{radius * std::cos(angle), radius * std::sin(angle)};
        const bool inside = winding(petal, p) != 0;
        const double distance = inside ? 0 : distance_to(petal, p);
        if (distance < 0.0999 || (distance > 0.1001 && p.x < 99)) { // no mitre of a tip is there
            ASSERT_EQ(winding(grown, p), distance < 0.1 ? 1 : 0) << p.x << ' ' << p.y;
        }
    }
    std::reverse(rings.begin(), rings.end());
    EXPECT_TRUE(same_contours(offset(layer_of(rings), 0.1), grown));
}

TEST(Offset, ScalesWithTheLayer) {
    Random random(86);
    const Layer layer = test::random_material(random, false);
    const double expected = area(offset(layer, -0.2));
    for (const double scale : {0x1p-400, 1e-6, 1e6, 0x1p400}) {
        std::vector<Contour> scaled;
        for (std::size_t i = 0; i < layer.rings; ++i) {
            Contour& ring = scaled.emplace_back(layer.contour(i).begin(), layer.contour(i).end());
            for (Point2& p : ring)
                p = {p.x * scale, p.y * scale};
        }
        EXPECT_NEAR(area(offset(layer_of(scaled), -0.2 * scale)) / scale / scale, expected, 1e-6);
    }
}

} // namespace
} // namespace lamella::offset_cases
