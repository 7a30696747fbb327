#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/boolean.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "scan/hatch_lines.hpp"
#include "scan/random_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

namespace lamella::hatch_lines_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::rounds_within_reason;

constexpr CosSin along_x{1, 0};

double length_on(const HatchLines& lines, std::size_t i) {
    double length = 0;
    for (std::size_t k = 0; k < lines.ends(i).size(); k += 2)
        length += lines.ends(i)[k + 1] - lines.ends(i)[k];
    return length;
}

double length_of(const HatchLines& lines) {
    double length = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
        length += length_on(lines, i);
    return length;
}

TEST(HatchLines, OnAnEdgeCountWhatIsAbove) {
    const HatchLines lines(layer_of({rectangle(1, 2, 5, 4)}), along_x, 1);
    ASSERT_EQ(lines.size(), 2U); // not the one along the upper edge
    EXPECT_EQ(lines.v(0), 2);
    EXPECT_EQ(lines.v(1), 3);
    for (std::size_t i = 0; i < lines.size(); ++i)
        EXPECT_EQ(std::vector<double>(lines.ends(i).begin(), lines.ends(i).end()),
                  (std::vector<double>{1, 5}));
}

TEST(HatchLines, OfNeighboursNeitherLeaveOutNorRepeatALine) {
    const HatchLines below(layer_of({rectangle(0, 0, 4, 3)}), along_x, 1);
    const HatchLines above(layer_of({rectangle(0, 3, 4, 7)}), along_x, 1);
    EXPECT_EQ(below.v(below.size() - 1), 2);
    EXPECT_EQ(above.v(0), 3);
}

TEST(HatchLines, LieAtMultiplesOfTheDistanceWhateverTheyCross) {
    for (const double y : {-1000.03, 0.0, 12.3456, 1e6})
        for (const double distance : {0.1, 0.07, 3.0}) {
            const HatchLines lines(layer_of({rectangle(y, y, y + 9, y + 9)}), along_x, distance);
            for (std::size_t i = 0; i < lines.size(); ++i)
                EXPECT_EQ(lines.v(i), std::round(lines.v(i) / distance) * distance);
        }
}

// Corners on a grid of integers, lines on it too: where edges cross lines are fractions whose denominators
// divide `whole`, so all lengths are integers in that unit. Corners lie on lines, edges run along them, rings
// cross and touch.
TEST(HatchLines, CoverExactlyAsMuchAsFractionsSay) {
    constexpr std::int64_t extent = 20;
    constexpr std::int64_t whole = 232792560; // least common multiple of 1 to 20
    Random random(1);
    for (int round = 0; round < rounds_within_reason(5000); ++round) {
        const Layer layer = test::random_rings(random, extent);
        std::map<std::int64_t, std::vector<std::int64_t>> expected;
        for (std::size_t r = 0; r < layer.rings; ++r)
            for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
                Point2 a = layer.contour(r)[i];
                Point2 b = layer.contour(r)[(i + 1) % layer.contour(r).size()];
                if (a.y > b.y)
                    std::swap(a, b);
                const auto x0 = static_cast<std::int64_t>(a.x);
                const auto y0 = static_cast<std::int64_t>(a.y);
                const auto x1 = static_cast<std::int64_t>(b.x);
                const auto y1 = static_cast<std::int64_t>(b.y);
                for (std::int64_t y = y0; y < y1; ++y)
                    expected[y].push_back(x0 * whole + (y - y0) * (x1 - x0) * (whole / (y1 - y0)));
            }
        const HatchLines lines(layer, along_x, 1);
        std::size_t total = 0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            std::vector<std::int64_t>& ends = expected[static_cast<std::int64_t>(lines.v(i))];
            std::sort(ends.begin(), ends.end());
            ASSERT_EQ(lines.ends(i).size(), ends.size());
            std::int64_t length = 0;
            for (std::size_t k = 0; k < ends.size(); k += 2)
                length += ends[k + 1] - ends[k];
            EXPECT_NEAR(length_on(lines, i), static_cast<double>(length) / static_cast<double>(whole), 1e-12);
            total += ends.size();
        }
        EXPECT_EQ(lines.total(), total);
        for (const auto& [y, ends] : expected)
            total -= ends.size();
        EXPECT_EQ(total, 0U); // no line was left out
    }
}

TEST(HatchLines, HaveEndsInPairsInOrderWithinTheMaterialAtEveryScaleAndAngle) {
    Random random(2);
    for (int round = 0; round < rounds_within_reason(3000); ++round) {
        const double scale = std::array{1.0, 1e6, 1e-6, 0.037}[round % 4];
        const Layer layer = test::scaled(test::random_material(random, 16), scale);
        const double degrees = round % 3 == 0 ? 45.0 * static_cast<double>(round % 8) : random.real(0, 360);
        const double distance = scale * (round % 5 == 0 ? 1.0 : random.real(0.3, 4));
        const HatchLines lines(layer, cos_sin_degrees(degrees), distance);
        const LineFrame& frame = lines.frame();
        double perimeter = 0;
        for (std::size_t r = 0; r < layer.rings; ++r)
            perimeter += contour_length(layer.contour(r), true);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const std::span<const double> ends = lines.ends(i);
            ASSERT_EQ(ends.size() % 2, 0U);
            ASSERT_TRUE(std::is_sorted(ends.begin(), ends.end()));
            for (std::size_t k = 0; k < ends.size(); k += 2) {
                // A winding number, of the middle of each line; where it lies clear of all edges.
                const Point2 middle = frame.point((ends[k] + ends[k + 1]) / 2, lines.v(i));
                double winding = 0;
                double clear = scale;
                for (std::size_t r = 0; r < layer.rings; ++r)
                    for (std::size_t e = 0; e < layer.contour(r).size(); ++e) {
                        const Point2& a = layer.contour(r)[e];
                        const Point2& b = layer.contour(r)[(e + 1) % layer.contour(r).size()];
                        const Point2 u{a.x - middle.x, a.y - middle.y};
                        const Point2 w{b.x - middle.x, b.y - middle.y};
                        winding += std::atan2(u.x * w.y - u.y * w.x, u.x * w.x + u.y * w.y);
                        const double length = std::hypot(b.x - a.x, b.y - a.y);
                        clear = std::min(clear, std::abs(u.x * w.y - u.y * w.x) / length);
                    }
                if (clear > 1e-9 * scale) {
                    EXPECT_GT(winding, 6) << round;
                }
            }
        }
        // By Cauchy and Crofton, lines times their distance make the area, but for half a line along each
        // edge.
        EXPECT_NEAR(length_of(lines) * distance, measure(layer).area_mm2,
                    perimeter * distance + 1e-9 * scale * scale);
    }
}

TEST(HatchLines, DoNotDependOnTheOrderOfRingsNorOnWhereTheyBegin) {
    Random random(3);
    for (int round = 0; round < 100; ++round) {
        std::vector<Contour> rings = test::contours(test::random_material(random, 16));
        const CosSin angle = cos_sin_degrees(random.real(0, 360));
        const HatchLines lines(layer_of(rings), angle, 0.3);
        std::reverse(rings.begin(), rings.end());
        for (Contour& ring : rings)
            std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(ring.size() / 2),
                        ring.end());
        const HatchLines others(layer_of(rings), angle, 0.3);
        ASSERT_EQ(lines.size(), others.size());
        for (std::size_t i = 0; i < lines.size(); ++i)
            EXPECT_TRUE(std::equal(lines.ends(i).begin(), lines.ends(i).end(), others.ends(i).begin(),
                                   others.ends(i).end()));
    }
}

// Cut line by line they are what lines through the cut layers are.
TEST(HatchLines, AreCutAsLayersAre) {
    Random random(5);
    for (int round = 0; round < rounds_within_reason(1000); ++round) {
        const Layer a = test::random_material(random, 16);
        const Layer b = test::random_material(random, 16);
        const CosSin angle = cos_sin_degrees(round % 3 == 0 ? 0 : random.real(0, 360));
        const double distance = round % 2 == 0 ? 1 : 0.37;
        const HatchLines others(b, angle, distance);
        for (const BooleanOperation operation : {BooleanOperation::intersect, BooleanOperation::subtract}) {
            HatchLines lines(a, angle, distance);
            const std::size_t size = lines.size();
            if (operation == BooleanOperation::intersect)
                lines.intersect(others);
            else
                lines.subtract(others);
            EXPECT_EQ(lines.size(), size);
            for (std::size_t i = 0; i < lines.size(); ++i) {
                EXPECT_EQ(lines.ends(i).size() % 2, 0U);
                EXPECT_TRUE(std::is_sorted(lines.ends(i).begin(), lines.ends(i).end()));
            }
            EXPECT_NEAR(length_of(lines), length_of(HatchLines(combine(a, b, operation), angle, distance)),
                        1e-6)
                << round;
        }
    }
}

TEST(HatchLines, WithNothingAreAllOrNone) {
    const Layer square = layer_of({rectangle(0, 0, 4, 4)});
    for (const Layer& other :
         {Layer{}, layer_of({rectangle(0, 9, 4, 12)}), layer_of({rectangle(9, 0, 12, 4)})}) {
        HatchLines kept(square, along_x, 1);
        kept.subtract(HatchLines(other, along_x, 1));
        EXPECT_EQ(length_of(kept), 16);
        kept.intersect(HatchLines(other, along_x, 1));
        EXPECT_EQ(kept.total(), 0U);
    }
}

TEST(HatchLines, OfNothingAndOfPointsAreNone) {
    EXPECT_EQ(HatchLines(Layer{}, along_x, 1).size(), 0U);
    EXPECT_EQ(HatchLines(layer_of({{{0, 0}}}), along_x, 1).total(), 0U);
    EXPECT_EQ(HatchLines(layer_of({{{0, 0}, {5, 5}}}), along_x, 1).total() % 2, 0U);
}

TEST(HatchLines, PassOverRingsWithoutPoints) {
    const HatchLines expected(layer_of({rectangle(0, 0, 4, 4)}), along_x, 0.5, 0.25);
    ASSERT_EQ(expected.size(), 8U);
    for (const std::vector<Contour>& rings : {std::vector<Contour>{{}, rectangle(0, 0, 4, 4)},
                                              {{}, {}, rectangle(0, 0, 4, 4), {}},
                                              {rectangle(0, 0, 4, 4), {}}}) {
        const HatchLines lines(layer_of(rings), along_x, 0.5, 0.25);
        ASSERT_EQ(lines.size(), expected.size());
        for (std::size_t i = 0; i < lines.size(); ++i)
            EXPECT_TRUE(std::equal(lines.ends(i).begin(), lines.ends(i).end(), expected.ends(i).begin(),
                                   expected.ends(i).end()));
    }
    EXPECT_EQ(HatchLines(layer_of({{}, {}}), along_x, 0.5, 0.25).size(), 0U);
}

TEST(HatchLines, AreRefusedWhereTheyWouldFillTheMemory) {
    const Layer square = layer_of({rectangle(0, 0, 100, 100)});
    EXPECT_THROW(HatchLines(square, along_x, 1e-9), Error);
    EXPECT_THROW(HatchLines(square, along_x, 1e-300), Error);
    std::vector<Contour> comb;
    for (int i = 0; i < 200; ++i)
        comb.push_back(rectangle(i, 0, i + 0.5, 100));
    EXPECT_THROW(HatchLines(layer_of(comb), along_x, 1e-4), Error); // a million lines of 200 pieces
    EXPECT_NO_THROW(HatchLines(square, along_x, 0.01, 0, LayerBudget({.memory = 1 << 20}, 0, 0)));
    EXPECT_THROW(HatchLines(square, along_x, 0.001, 0, LayerBudget({.memory = 1 << 20}, 0, 0)), Error);
}

} // namespace
} // namespace lamella::hatch_lines_cases
