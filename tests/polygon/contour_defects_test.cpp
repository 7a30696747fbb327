#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/contour_defects.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace lamella::contour_defects_cases {
namespace {

using Row = std::tuple<std::string, std::size_t, std::size_t, double, double>;

std::vector<Row> rows_of(const ContourDefects& defects) {
    std::vector<Row> rows;
    for (const ContourDefect& defect : defects.found)
        rows.emplace_back(contour_defect_name(defect.kind), defect.contour, defect.other, defect.at.x,
                          defect.at.y);
    return rows;
}

/// Makes a layer of rings, then chains, in this order.
Layer layer_of(const std::vector<std::vector<Point2>>& rings,
               const std::vector<std::vector<Point2>>& chains = {}) {
    LayerBuilder builder;
    for (const std::vector<Point2>& ring : rings)
        builder.add_contour(ring, true);
    for (const std::vector<Point2>& chain : chains)
        builder.add_contour(chain, false);
    return builder.finish_as_added(0, 0.5, 0, 1);
}

std::vector<Point2> square(double x, double y, double side) {
    return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

std::vector<Point2> clockwise(std::vector<Point2> ring) {
    return {ring.rbegin(), ring.rend()};
}

TEST(ContourDefects, ASoundLayerHasNone) {
    EXPECT_TRUE(contour_defects({}).found.empty());
    EXPECT_TRUE(contour_defects(layer_of({square(0, 0, 10), clockwise(square(2, 2, 3))})).found.empty());
}

Layer turned(std::vector<Point2> ring, double radians) {
    for (Point2& p : ring)
        p = {std::cos(radians) * p.x - std::sin(radians) * p.y,
             std::sin(radians) * p.x + std::cos(radians) * p.y};
    return normal_form(layer_of({ring}));
}

TEST(ContourDefects, AreNoneOfRingsThatCrossThemselvesByRoundingOnly) {
    std::uint64_t crossed = 0;
    for (int i = 0; i < 500; ++i) {
        // A square whose left side runs up and down over itself.
        const auto zigzag = [&](double g) {
            return turned({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {g, 3}, {-g, 7}, {0, 5}, {0, 8}, {0, 1}},
                          0.0123 * i);
        };
        crossed += has_crossings(zigzag(0)) ? 1 : 0;
        EXPECT_TRUE(contour_defects(zigzag(0)).found.empty()) << i;
        EXPECT_GT(contour_defects(zigzag(1e-9)).crossings, 0U) << i;
    }
    EXPECT_GT(crossed, 100U);
}

TEST(ContourDefects, AreNoneOfRingsThatRoundingTurnsAtTheirLeftEnds) {
    std::uint64_t loops = 0;
    for (int i = 0; i < 500; ++i) {
        // A square with a spike of no width to the left.
        const Layer layer = turned(
            {{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 5}, {-1, 5}, {-3, 5}, {-2, 5}, {0, 5}}, 0.001 * (i - 250));
        loops += nesting(layer).kind[0] == RingKind::misoriented ? 1 : 0;
        EXPECT_TRUE(contour_defects(layer).found.empty()) << i;
    }
    EXPECT_GT(loops, 50U);
    // A loop that is larger than the rounding is a defect.
    const Layer layer = turned({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 5}, {-3, 4}, {-3, 6}, {0, 5}}, 0);
    EXPECT_EQ(contour_defects(layer).found.size(), 1U);
}

TEST(ContourDefects, NamesTheContourAndThePositionOfEachKind) {
    const Layer layer = layer_of(
        {square(0, 0, 10), square(2, 2, 3), clockwise(square(20, 0, 5)), square(21, 1, 2), square(9, 9, 4)},
        {{{40, 1}, {50, 1}}});
    const ContourDefects defects = contour_defects(layer);
    EXPECT_EQ(rows_of(defects), (std::vector<Row>{{"open", 5, 5, 40, 1},
                                                  {"crossing", 0, 4, 10, 9},
                                                  {"crossing", 0, 4, 9, 10},
                                                  {"overlapping", 1, 1, 2, 2},
                                                  {"misoriented", 2, 2, 20, 5},
                                                  {"tangled", 3, 3, 21, 1},
                                                  {"overlapping", 4, 4, 9, 9}}));
    EXPECT_EQ(defects.crossings, 2U);
    EXPECT_FALSE(defects.or_more);
}

TEST(ContourDefects, ARingMayCrossItself) {
    const ContourDefects defects = contour_defects(layer_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}}));
    ASSERT_FALSE(defects.found.empty());
    EXPECT_EQ(rows_of(defects).front(), Row("crossing", 0, 0, 2, 2));
}

TEST(ContourDefects, ListsAsManyCrossingsAsAskedForAndCountsAll) {
    const Layer comb = layer_of({square(0, 0, 10)}, {{{-1, 1}, {11, 1}, {11, 2}, {-1, 2}}});
    const ContourDefects defects = contour_defects(comb, {}, 1);
    EXPECT_EQ(defects.crossings, 4U);
    EXPECT_EQ(defects.found.size(), 2U) << "the chain, and one crossing";
}

TEST(ContourDefects, RoundingMayInvertAThinRing) {
    const Layer sliver = layer_of({clockwise({{0, 0}, {10, 0}, {10, 1e-3}})});
    EXPECT_EQ(rows_of(contour_defects(sliver)).size(), 1U);
    EXPECT_TRUE(contour_defects(sliver, {.step_mm = 0.01}).found.empty());
}

} // namespace
} // namespace lamella::contour_defects_cases
