#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/cells.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace lamella::cells_cases {
namespace {

using test::Contour;
using test::diamond;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

/// Returns the area in which material of one layer meets material of the other, or space of it.
double shared_mm2(const LayerCells& first, const LayerCells& second, bool first_is, bool second_is) {
    double sum = 0;
    for (const CellOverlap& overlap : overlaps(first, second))
        if (first.cells[overlap.first].material == first_is &&
            second.cells[overlap.second].material == second_is)
            sum += overlap.area_mm2;
    return sum;
}

/// Returns whether any material of one layer meets material of the other.
bool material_meets(const Layer& first, const Layer& second) {
    return shared_mm2(cells_of(first), cells_of(second), true, true) > 0;
}

TEST(LayerCells, NamesTheSpaceInAHoleAndTheBodyInIt) {
    const LayerCells cells = cells_of(
        normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(2, 2, 8, 8)), rectangle(4, 4, 5, 5)}));
    ASSERT_EQ(cells.cells.size(), 4U);
    EXPECT_EQ(cells.around, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(cells.cells[1].material && !cells.cells[2].material && cells.cells[3].material);
    EXPECT_DOUBLE_EQ(cells.cells[1].area_mm2, 64);
    EXPECT_DOUBLE_EQ(cells.cells[2].area_mm2, 35);
    EXPECT_DOUBLE_EQ(cells.cells[3].area_mm2, 1);
    EXPECT_DOUBLE_EQ(cells.cells[1].centre.x, 5);
    EXPECT_DOUBLE_EQ(cells.cells[3].centre.y, 4.5);
}

TEST(LayerCells, UnitesOverlapsAndDissolvesWalls) {
    const LayerCells overlapping = cells_of(normal_layer({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)}));
    ASSERT_EQ(overlapping.cells.size(), 2U);
    EXPECT_NEAR(overlapping.cells[1].area_mm2, 28, 1e-9);
    const LayerCells adjacent = cells_of(normal_layer({rectangle(0, 0, 4, 4), rectangle(4, 0, 6, 4)}));
    ASSERT_EQ(adjacent.cells.size(), 2U);
    EXPECT_NEAR(adjacent.cells[1].area_mm2, 24, 1e-9);
}

TEST(LayerCells, UnitesWallsWithGapsOfRoundingErrors) {
    for (int degrees = 0; degrees < 360; degrees += 7) {
        const double angle = degrees * std::numbers::pi / 180;
        std::vector<Contour> walls{rectangle(0, 0, 9, 1), rectangle(0, 1, 1, 8), rectangle(8, 1, 9, 8),
                                   rectangle(0, 8, 9, 9)};
        for (Contour& wall : walls)
            for (Point2& p : wall)
                p = {p.x * std::cos(angle) - p.y * std::sin(angle),
                     p.x * std::sin(angle) + p.y * std::cos(angle)};
        const LayerCells cells = cells_of(normal_layer(walls));
        ASSERT_EQ(cells.cells.size(), 3U) << degrees;
        EXPECT_NEAR(cells.cells[1].area_mm2, 81 - 49, 1e-6);
        EXPECT_NEAR(cells.cells[2].area_mm2, 49, 1e-6);
    }
}

TEST(LayerCells, HaveNoMaterialWhereRingsCancel) {
    const Contour square = rectangle(0, 0, 4, 4);
    EXPECT_EQ(cells_of(normal_layer({square, reversed(square)})).cells.size(), 1U);
}

// After uniting, a ring of these is so small that it runs one way at its left end and the other way in all.
TEST(LayerCells, LeavesOutRingsAsSmallAsRoundingErrors) {
    const LayerCells cells = cells_of(normal_layer({{{1.6, -0.3}, {0.85, 1.5}, {0.3, 0.8}, {0.2, 0.6}},
                                                    {{0.69503, 1.299919},
                                                     {0.7009008845174772, 1.3000399352388485},
                                                     {0.7031850218772888, 1.3000869750976562},
                                                     {0.7, 1.32}},
                                                    {{0.704, 1.3003},
                                                     {0.7031850218772888, 1.3000869750976562},
                                                     {0.6959454270023167, 1.2999378818221223},
                                                     {0.7, 1.3}},
                                                    {{0.71, 0.4434}, {0.6956, 0.498}, {0.7, 0.5}}}));
    for (std::size_t ring = 0; ring < cells.layer.rings; ++ring)
        EXPECT_EQ(ring_area(cells.layer.contour(ring)) > 0, cells.cells[ring + 1].material);
    LayerCells space;
    space.cells.resize(1);
    for (const CellOverlap& overlap : overlaps(space, cells))
        EXPECT_LT(overlap.second, cells.cells.size());
}

TEST(LayerCells, KeepsBodiesApartThatTouchInAPoint) {
    const LayerCells cells = cells_of(normal_layer({rectangle(0, 0, 4, 4), rectangle(4, 4, 6, 6)}));
    EXPECT_EQ(cells.cells.size(), 3U);
}

TEST(LayerCells, LeavesOutOpenChains) {
    const LayerCells cells = cells_of(normal_layer({rectangle(0, 0, 4, 4)}, {{{1, 1}, {2, 2}, {3, 1}}}));
    EXPECT_EQ(cells.layer.contours(), 1U);
    EXPECT_EQ(cells.layer.points.size(), 4U);
    EXPECT_EQ(cells.cells.size(), 2U);
}

TEST(LayerCells, ReturnsTheMaterialOfSomeCells) {
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(2, 2, 8, 8)),
                                      rectangle(4, 4, 5, 5), rectangle(20, 0, 21, 1)});
    const LayerCells cells = cells_of(layer);
    EXPECT_DOUBLE_EQ(measure(material_of(cells, {false, true, false, false, false})).area_mm2, 64);
    EXPECT_DOUBLE_EQ(measure(material_of(cells, {false, false, false, true, true})).area_mm2, 2);
    EXPECT_TRUE(same_contours(material_of(cells, {false, true, false, true, true}), cells.layer));
}

TEST(CellOverlaps, OfALayerWithItselfAreItsCells) {
    const LayerCells cells = cells_of(
        normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(2, 2, 8, 8)), rectangle(4, 4, 5, 5)}));
    const std::vector<CellOverlap> found = overlaps(cells, cells);
    ASSERT_EQ(found.size(), 4U);
    for (std::uint32_t cell = 0; cell < 4; ++cell) {
        EXPECT_EQ(found[cell].first, cell);
        EXPECT_EQ(found[cell].second, cell);
        EXPECT_DOUBLE_EQ(found[cell].area_mm2, cells.cells[cell].area_mm2);
    }
}

TEST(CellOverlaps, AreNoneWhereBodiesTouchInAPointOrAnEdge) {
    const Layer square = normal_layer({rectangle(0, 0, 4, 4)});
    EXPECT_FALSE(material_meets(square, normal_layer({rectangle(4, 4, 6, 6)})));
    EXPECT_FALSE(material_meets(square, normal_layer({rectangle(4, 0, 6, 4)})));
    EXPECT_FALSE(material_meets(square, normal_layer({rectangle(4, 1, 6, 2)})));
    EXPECT_FALSE(material_meets(square, normal_layer({rectangle(5, 1, 6, 2)})));
    EXPECT_TRUE(material_meets(square, normal_layer({rectangle(4 - 1e-6, 1, 6, 2)})));
    EXPECT_TRUE(material_meets(square, normal_layer({rectangle(1, 1, 2, 2)})));
    EXPECT_TRUE(material_meets(square, normal_layer({rectangle(-1, -1, 5, 5)})));
    EXPECT_TRUE(material_meets(square, normal_layer({diamond(2, 2, 2)})));
    // In a hole of the same size, and in one that is a little smaller.
    const Layer frame = normal_layer({rectangle(0, 0, 9, 9), reversed(rectangle(2, 2, 7, 7))});
    EXPECT_FALSE(material_meets(frame, normal_layer({rectangle(2, 2, 7, 7)})));
    EXPECT_FALSE(material_meets(frame, normal_layer({diamond(4.5, 4.5, 2.5)})));
    EXPECT_TRUE(material_meets(frame, normal_layer({diamond(4.5, 4.5, 2.5001)})));
    EXPECT_FALSE(material_meets(frame, normal_layer({diamond(4.5, 4.5, 2.25)})));
}

TEST(CellOverlaps, FindAllPairsAlsoOfSpaces) {
    const LayerCells frame =
        cells_of(normal_layer({rectangle(0, 0, 9, 9), reversed(rectangle(2, 2, 7, 7))})); // cells 0, 1, 2
    const LayerCells block = cells_of(normal_layer({rectangle(1, 3, 12, 4)}));            // cells 0, 1
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const CellOverlap& overlap : overlaps(frame, block))
        pairs.emplace_back(overlap.first, overlap.second);
    EXPECT_EQ(pairs, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{
                         {0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}}));
}

/// A layer of random bodies and holes, many of whose sides lie on common lines.
Layer random_layer(Random& random) {
    std::vector<Contour> rings;
    const auto number = [&](std::int64_t most) {
        return static_cast<double>(random.integer(0, most));
    };
    for (std::int64_t i = random.integer(0, 5); i >= 0; --i) {
        const double x = number(8);
        const double y = number(8);
        Contour ring = random.integer(0, 2) == 0 ? diamond(x, y, 1 + number(3))
                                                 : rectangle(x, y, x + 1 + number(5), y + 1 + number(5));
        rings.push_back(random.integer(0, 4) == 0 ? reversed(std::move(ring)) : std::move(ring));
    }
    return normal_layer(rings);
}

TEST(CellOverlaps, AddUpToTheAreasThatStripsGive) {
    Random random(7);
    for (int round = 0; round < 400; ++round) {
        const Layer a = random_layer(random);
        const Layer b = random_layer(random);
        const LayerCells first = cells_of(a);
        const LayerCells second = cells_of(b);
        const auto expected = [&](bool in_first, bool in_second) {
            return test::winding_area(a, b, [&](int v, int w) {
                return (v > 0) == in_first && (w > 0) == in_second && (in_first || in_second);
            });
        };
        EXPECT_NEAR(shared_mm2(first, second, true, true), expected(true, true), 1e-8);
        EXPECT_NEAR(shared_mm2(first, second, true, false), expected(true, false), 1e-8);
        EXPECT_NEAR(shared_mm2(first, second, false, true), expected(false, true), 1e-8);
        // The overlaps of each cell add up to its area.
        std::vector<double> sums(second.cells.size(), 0);
        for (const CellOverlap& overlap : overlaps(first, second))
            sums[overlap.second] += overlap.area_mm2;
        for (std::size_t cell = 1; cell < sums.size(); ++cell)
            EXPECT_NEAR(sums[cell], second.cells[cell].area_mm2, 1e-8);
    }
}

TEST(CellOverlaps, DoNotDependOnTheOrderOfTheLayers) {
    Random random(8);
    for (int round = 0; round < 100; ++round) {
        const LayerCells first = cells_of(random_layer(random));
        const LayerCells second = cells_of(random_layer(random));
        std::vector<std::pair<std::uint32_t, std::uint32_t>> forwards;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> backwards;
        for (const CellOverlap& overlap : overlaps(first, second))
            forwards.emplace_back(overlap.first, overlap.second);
        for (const CellOverlap& overlap : overlaps(second, first))
            backwards.emplace_back(overlap.second, overlap.first);
        std::sort(backwards.begin(), backwards.end());
        EXPECT_EQ(forwards, backwards);
    }
}

} // namespace
} // namespace lamella::cells_cases
