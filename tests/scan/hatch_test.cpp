#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "scan/hatch.hpp"
#include "scan/hatch_lines.hpp"
#include "scan/random_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace lamella::hatch_cases {
namespace {

using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;
using test::rounds_within_reason;

constexpr std::array patterns{HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                              HatchPattern::chessboard, HatchPattern::hexagons};

struct Vector {
    Point2 from;
    Point2 to;

    [[nodiscard]] double length() const { return std::hypot(to.x - from.x, to.y - from.y); }
};

std::vector<Vector> vectors_of(const PointArray& points) {
    EXPECT_EQ(points.size() % 2, 0U);
    std::vector<Vector> vectors;
    for (std::size_t i = 0; i < points.size(); i += 2)
        vectors.push_back({points[i], points[i + 1]});
    return vectors;
}

double marked(const std::vector<Vector>& vectors) {
    double length = 0;
    for (const Vector& vector : vectors)
        length += vector.length();
    return length;
}

double jumped(const std::vector<Vector>& vectors) {
    double length = 0;
    for (std::size_t i = 1; i < vectors.size(); ++i)
        length += Vector{vectors[i - 1].to, vectors[i].from}.length();
    return length;
}

/// Without what keeps vectors from covering all.
HatchRule bare(HatchPattern pattern, double distance, double cell) {
    HatchRule rule;
    rule.pattern = pattern;
    rule.distance = distance;
    rule.cell = cell;
    rule.overlap = 0;
    rule.shortest = 0;
    return rule;
}

double perimeter(const Layer& layer) {
    double sum = 0;
    for (std::size_t i = 0; i < layer.rings; ++i)
        sum += contour_length(layer.contour(i), true);
    return sum;
}

TEST(Hatch, LinesAreTurnedFromLayerToLayer) {
    HatchRule rule = bare(HatchPattern::lines, 0.5, 5);
    rule.angle_degrees = 10;
    rule.turn_degrees = 67;
    for (const std::uint64_t layer : {0ULL, 1ULL, 2ULL, 90'000'000'000ULL}) {
        Layer square = layer_of({rectangle(-9, -9, 9, 9)});
        square.index = layer;
        const double degrees = 10 + static_cast<double>(layer % 360) * 67;
        const CosSin angle = cos_sin_degrees(degrees);
        const std::vector<Vector> vectors = vectors_of(hatch(square, rule, 1));
        ASSERT_GT(vectors.size(), 30U);
        for (const Vector& vector : vectors) {
            const double along =
                (vector.to.x - vector.from.x) * angle.cos + (vector.to.y - vector.from.y) * angle.sin;
            EXPECT_NEAR(along, vector.length(), 1e-9) << layer;
        }
    }
}

TEST(Hatch, MeandersGoBackAndForth) {
    const Layer square = layer_of({rectangle(0, 0, 10, 10)});
    const std::vector<Vector> lines = vectors_of(hatch(square, bare(HatchPattern::lines, 0.5, 5), 1));
    const std::vector<Vector> meander = vectors_of(hatch(square, bare(HatchPattern::meander, 0.5, 5), 1));
    ASSERT_EQ(lines.size(), 20U);
    ASSERT_EQ(meander.size(), 20U);
    EXPECT_NEAR(marked(meander), marked(lines), 1e-12);
    EXPECT_NEAR(jumped(meander), 19 * 0.5, 1e-12);
    EXPECT_GT(jumped(lines), 19 * 10);
}

TEST(Hatch, StripesCutLinesAtMultiplesOfTheirWidthFromTheOriginOfTheMachine) {
    const Layer plate = layer_of({rectangle(-7, 1, 13, 3)});
    const std::vector<Vector> vectors = vectors_of(hatch(plate, bare(HatchPattern::stripes, 1, 5), 1));
    std::set<std::pair<double, double>> pieces;
    for (const Vector& vector : vectors)
        pieces.insert(std::minmax(vector.from.x, vector.to.x));
    EXPECT_EQ(pieces, (std::set<std::pair<double, double>>{{-7, -5}, {-5, 0}, {0, 5}, {5, 10}, {10, 13}}));
    EXPECT_EQ(vectors.size(), 10U);
    for (std::size_t i = 1; i < vectors.size(); ++i) // stripe by stripe, none comes back
        EXPECT_LE(std::floor(std::min(vectors[i - 1].from.x, vectors[i - 1].to.x) / 5),
                  std::floor(std::min(vectors[i].from.x, vectors[i].to.x) / 5));
}

TEST(Hatch, StripesOverlapWhereMaterialGoesOn) {
    HatchRule rule = bare(HatchPattern::stripes, 1, 5);
    rule.overlap = 0.5;
    const std::vector<Vector> vectors = vectors_of(hatch(layer_of({rectangle(0, 0, 10, 1)}), rule, 1));
    ASSERT_EQ(vectors.size(), 2U);
    EXPECT_EQ(vectors[0].to.x, 5.25);
    EXPECT_EQ(vectors[1].from.x + vectors[1].to.x, 4.75 + 10);
}

TEST(Hatch, ALineThatEndsJustBeyondAStripeIsNotTornOff) {
    HatchRule rule = bare(HatchPattern::stripes, 1, 5);
    rule.shortest = 0.3;
    const std::vector<Vector> vectors = vectors_of(hatch(layer_of({rectangle(-0.2, 0, 5.2, 1)}), rule, 1));
    ASSERT_EQ(vectors.size(), 1U);
    EXPECT_NEAR(vectors[0].length(), 5.4, 1e-12);
}

TEST(Hatch, LeavesShortLinesOut) {
    const Layer layer = layer_of({rectangle(0, 0, 10, 10), rectangle(20, 0, 20.2, 10)});
    for (const HatchPattern pattern : patterns) {
        HatchRule rule = bare(pattern, 0.5, 5);
        rule.angle_degrees = 45;
        rule.shortest = 0.4;
        for (const Vector& vector : vectors_of(hatch(layer, rule, 1)))
            EXPECT_GE(vector.length(), 0.4 - 1e-9) << hatch_pattern_name(pattern);
    }
}

// Whatever cells cut, stripes cover what lines do; squares and hexagons cover it by lines in several
// directions.
TEST(Hatch, EveryPatternCoversTheMaterialOnce) {
    Random random(4);
    for (int round = 0; round < rounds_within_reason(400); ++round) {
        Layer layer = test::random_material(random, 24);
        layer.index = static_cast<std::uint64_t>(random.integer(0, 1000));
        const double area = measure(layer).area_mm2;
        const double cell = random.real(2, 9);
        const double distance = random.real(0.05, 0.4);
        HatchRule rule = bare(HatchPattern::lines, distance, cell);
        rule.angle_degrees = random.real(-400, 400);
        const double by_lines = marked(vectors_of(hatch(layer, rule, 1)));
        for (const HatchPattern pattern : patterns) {
            rule.pattern = pattern;
            const std::vector<Vector> vectors = vectors_of(hatch(layer, rule, 1));
            if (pattern == HatchPattern::chessboard || pattern == HatchPattern::hexagons) {
                // Each cell's lines miss its area by half a line along its border.
                const double borders = perimeter(layer) + 6 * area / cell + 40 * cell;
                EXPECT_NEAR(marked(vectors) * distance, area, borders * distance)
                    << hatch_pattern_name(pattern);
                rule.order = IslandOrder::random;
                EXPECT_NEAR(marked(vectors_of(hatch(layer, rule, 7))), marked(vectors), 1e-6);
                rule.order = IslandOrder::rows;
            } else {
                EXPECT_NEAR(marked(vectors), by_lines, 1e-6) << hatch_pattern_name(pattern);
            }
        }
    }
}

TEST(Hatch, NeighbouringIslandsHaveOtherDirections) {
    const Layer square = layer_of({rectangle(0, 0, 30, 30)});
    const auto directions = [&](HatchPattern pattern) {
        std::set<long> found;
        HatchRule rule = bare(pattern, 0.25, 5);
        rule.shortest = 1e-6;
        for (const Vector& vector : vectors_of(hatch(square, rule, 1))) {
            const double degrees =
                std::atan2(vector.to.y - vector.from.y, vector.to.x - vector.from.x) * 57.29577951;
            found.insert(std::lround(std::fmod(degrees + 360, 180)) % 180);
        }
        return found;
    };
    EXPECT_EQ(directions(HatchPattern::stripes), (std::set<long>{0}));
    EXPECT_EQ(directions(HatchPattern::chessboard), (std::set<long>{0, 90}));
    EXPECT_EQ(directions(HatchPattern::hexagons), (std::set<long>{0, 60, 120}));
}

TEST(Hatch, SquaresAreHatchedOneByOneAcrossTheirNeighbours) {
    const Layer square = layer_of({rectangle(0, 0, 20, 20)});
    const std::vector<Vector> vectors = vectors_of(hatch(square, bare(HatchPattern::chessboard, 0.5, 5), 1));
    EXPECT_EQ(vectors.size(), 16U * 10U);
    for (std::size_t i = 0; i < vectors.size(); i += 10) {
        const auto column = [](const Vector& v) {
            return std::ceil((v.from.x + v.to.x) / 2 / 5);
        };
        const auto row = [](const Vector& v) {
            return std::floor((v.from.y + v.to.y) / 2 / 5);
        };
        for (std::size_t k = i; k < i + 10; ++k) {
            EXPECT_EQ(column(vectors[k]), column(vectors[i]));
            EXPECT_EQ(row(vectors[k]), row(vectors[i]));
            const bool along_x = vectors[k].from.y == vectors[k].to.y;
            EXPECT_EQ(along_x, std::fmod(column(vectors[i]) + row(vectors[i]), 2) == 1);
        }
    }
    EXPECT_LT(jumped(vectors), 16 * 9 * 0.5 + 16 * 15);
}

TEST(Hatch, IslandsAtRandomComeInAnotherOrderForEachSeedAndLayer) {
    Layer square = layer_of({rectangle(0, 0, 40, 40)});
    HatchRule rule = bare(HatchPattern::chessboard, 0.5, 5);
    rule.turn_degrees = 0;
    rule.order = IslandOrder::random;
    const auto points = [&](std::uint64_t seed) {
        const PointArray hatches = hatch(square, rule, seed);
        return std::vector<Point2>(hatches.begin(), hatches.end());
    };
    const std::vector<Point2> once = points(1);
    EXPECT_EQ(once, points(1));
    EXPECT_NE(once, points(2));
    square.index = 1;
    EXPECT_NE(once, points(1));
}

TEST(Hatch, SixHexagonsLieAroundEachWithoutGapsOrOverlaps) {
    // A plate much larger than a hexagon: all of its lines together make its area to 1 in 1,000.
    const Layer plate = layer_of({rectangle(0, 0, 100, 100)});
    HatchRule rule = bare(HatchPattern::hexagons, 0.005, 7);
    rule.angle_degrees = 13;
    EXPECT_NEAR(marked(vectors_of(hatch(plate, rule, 1))) * rule.distance, 10000, 10);
    rule.overlap = 0.7;
    const double grown = marked(vectors_of(hatch(plate, rule, 1))) * rule.distance;
    EXPECT_NEAR(grown, 10000 * 1.1 * 1.1, 250); // each a tenth wider; those at the border less
}

/// Whether a place is within half a distance of a line, and not beyond its ends.
bool is_exposed(const std::vector<Vector>& vectors, const Point2& p, double distance) {
    return std::any_of(vectors.begin(), vectors.end(), [&](const Vector& vector) {
        const double length = vector.length();
        const Point2 way{(vector.to.x - vector.from.x) / length, (vector.to.y - vector.from.y) / length};
        const Point2 to{p.x - vector.from.x, p.y - vector.from.y};
        const double along = to.x * way.x + to.y * way.y;
        return -1e-6 <= along && along <= length + 1e-6 &&
               std::abs(to.x * way.y - to.y * way.x) <= distance / 2 * (1 + 1e-6);
    });
}

TEST(Hatch, CellsMeetWithoutAGapWhateverTheirOverlap) {
    Random random(41);
    const Layer square = layer_of({rectangle(-4, -4, 4, 4)});
    for (const HatchPattern pattern :
         {HatchPattern::stripes, HatchPattern::chessboard, HatchPattern::hexagons})
        for (const double cell : {1.0, 1.13, 2.0})
            for (const double overlap : {0.0, 0.01, 0.07, 0.1, 0.16, 0.3}) {
                HatchRule rule = bare(pattern, 0.1, cell);
                rule.shortest = 0.1;
                rule.overlap = overlap;
                rule.angle_degrees = random.real(0, 90);
                const std::vector<Vector> vectors = vectors_of(hatch(square, rule, 1));
                int bare_bodies = 0;
                for (int i = 0; i < rounds_within_reason(500); ++i) // far from the edge of the material
                    bare_bodies +=
                        is_exposed(vectors, {random.real(-3.7, 3.7), random.real(-3.7, 3.7)}, 0.1) ? 0 : 1;
                EXPECT_EQ(bare_bodies, 0) << hatch_pattern_name(pattern) << ' ' << cell << ' ' << overlap;
            }
}

TEST(Hatch, SquaresOfAWholeNumberOfLinesMeetWithoutAnOverlap) {
    for (const double cell : {1.0, 2.5, 5.0}) {
        HatchRule rule = bare(HatchPattern::chessboard, 0.1, cell);
        EXPECT_NEAR(marked(vectors_of(hatch(layer_of({rectangle(0, 0, 10, 10)}), rule, 1))) * 0.1, 100, 1e-6);
        rule.overlap = 0.1;
        rule.distance = 0.09; // as far apart as is asked for
        for (const Vector& vector : vectors_of(hatch(layer_of({rectangle(0, 0, 10, 10)}), rule, 1))) {
            const double across =
                std::abs(vector.from.x - vector.to.x) < 1e-9 ? vector.from.x : vector.from.y;
            EXPECT_NEAR(std::fmod(across / 0.09, 1), 0.5, 1e-6);
        }
    }
}

TEST(Hatch, WhatACellHasTooLittleOfIsExposedAllTheSame) {
    HatchRule rule = bare(HatchPattern::chessboard, 0.1, 5);
    rule.shortest = 0.3;
    // Two squares of each colour end just beyond a border of the cells.
    const Layer square = layer_of({rectangle(-0.1, -0.1, 5.1, 5.1)});
    const std::vector<Vector> vectors = vectors_of(hatch(square, rule, 1));
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const Point2 p{random.real(0.1, 4.9), random.real(-0.1, 5.1)};
        EXPECT_TRUE(is_exposed(vectors, p, 0.1) || is_exposed(vectors, p, 0.2)) << p.x << ' ' << p.y;
    }
    for (const Vector& vector : vectors)
        EXPECT_GE(vector.length(), 0.3 - 1e-12);
}

TEST(Hatch, AnyNumberOfPointsOnALine) {
    // Corners on lines, edges along them, holes that touch the outline.
    const Layer layer =
        layer_of({rectangle(0, 0, 8, 8), reversed(rectangle(2, 0, 4, 4)), reversed(rectangle(4, 4, 8, 6))});
    const std::vector<Vector> vectors = vectors_of(hatch(layer, bare(HatchPattern::lines, 1, 5), 1));
    EXPECT_EQ(marked(vectors), 4 * 6 + 2 * 4 + 2 * 8);
}

TEST(Hatch, RefusesMoreIslandsThanMemoryHolds) {
    const Layer square = layer_of({rectangle(0, 0, 100, 100)});
    for (const HatchPattern pattern :
         {HatchPattern::stripes, HatchPattern::chessboard, HatchPattern::hexagons})
        for (const double cell : {1e-5, 1e-9, 1e-300})
            EXPECT_THROW(static_cast<void>(hatch(square, bare(pattern, 0.1, cell), 1)), Error);
}

TEST(Hatch, IsRefusedBeforeItTakesMoreMemoryThanThereIsForTheLayer) {
    const Layer square = layer_of({rectangle(0, 0, 250, 250)});
    for (const HatchPattern pattern : patterns)
        test::expect_error(ErrorKind::limit, {"layer 7 at z = 0.5 mm", "`max_memory`", "`hatch.distance`"},
                           [&] {
                               static_cast<void>(hatch(square, bare(pattern, 0.01, 5), 1,
                                                       LayerBudget({.memory = 500'000}, 7, 0.5)));
                           });
    // Cells of one line each take more than their lines.
    test::expect_error(ErrorKind::limit, {"stripes or islands take", "a larger `hatch.cell`"}, [&] {
        static_cast<void>(hatch(square, bare(HatchPattern::hexagons, 1, 0.5), 1,
                                LayerBudget({.memory = 40'000'000}, 7, 0.5)));
    });
}

TEST(Hatch, FitsWhereThereIsRoomForItsVectors) {
    Random random(3);
    for (int round = 0; round < 10; ++round) {
        const Layer layer = layer_of({rectangle(0, 0, random.real(20, 60), random.real(20, 60)),
                                      reversed(rectangle(5, 5, 7, random.real(8, 18)))});
        for (const HatchPattern pattern : patterns) {
            const HatchRule rule = bare(pattern, random.real(0.05, 0.3), random.real(1, 6));
            const PointArray vectors = hatch(layer, rule, 1);
            constexpr std::uint64_t of_vector = 250;
            const PointArray again =
                hatch(layer, rule, 1, LayerBudget({.memory = of_vector * vectors.size() / 2}, 0, 0));
            EXPECT_TRUE(std::equal(vectors.begin(), vectors.end(), again.begin(), again.end()));
        }
    }
}

TEST(Hatch, HearsARequestToStop) {
    CancelFlag stop;
    stop.request();
    for (const HatchPattern pattern : patterns)
        test::expect_error(ErrorKind::cancelled, {}, [&] {
            static_cast<void>(hatch(layer_of({rectangle(0, 0, 10, 10)}), bare(pattern, 0.1, 5), 1,
                                    LayerBudget({.cancel = &stop}, 0, 0)));
        });
}

TEST(Hatch, ManyIslandsComeInTime) {
    const Layer square = layer_of({rectangle(0, 0, 100, 100)});
    EXPECT_GT(hatch(square, bare(HatchPattern::chessboard, 0.1, 0.1), 1).size(), 2 * 900'000U);
}

} // namespace
} // namespace lamella::hatch_cases
