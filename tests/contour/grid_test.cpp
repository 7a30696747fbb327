#include "contour/grid.hpp"
#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lamella {
namespace {

using test::Random;

using Cells = std::vector<std::size_t>;

Cells along(const Grid& grid, const Point2& a, const Point2& b) {
    Cells cells;
    grid.for_cells_along(a, b, [&](std::size_t cell) { cells.push_back(cell); });
    return cells;
}

Cells of_box(const Grid& grid, const Box2& box) {
    Cells cells;
    grid.for_cells(box, [&](std::size_t cell) { cells.push_back(cell); });
    return cells;
}

bool contains(const Cells& cells, std::size_t cell) {
    return std::find(cells.begin(), cells.end(), cell) != cells.end();
}

Box2 random_box(Random& random, const Box2& whole) {
    return Box2::of({random.real(whole.x0, whole.x1), random.real(whole.y0, whole.y1)},
                    {random.real(whole.x0, whole.x1), random.real(whole.y0, whole.y1)});
}

TEST(Grid, HasEveryPointOfASegmentInOneOfTheCellsAlongIt) {
    Random random(31);
    int inside = 0;
    for (int round = 0; round < 500; ++round) {
        const Box2 whole = random_box(random, {-10, -10, 90, 40});
        const Grid grid(whole, Grid::cell_size(whole, 1 + 200 * random.real(0, 1), 0));
        // From far outside to far outside, steep, flat and level.
        const double steepness = std::pow(10, random.real(-6, 3));
        const Point2 a{random.real(-50, 100), random.real(-50, 100)};
        const Point2 b{random.real(-50, 100), steepness * random.real(-50, 100)};
        Cells cells = along(grid, a, b);
        for (int i = 0; i <= 300; ++i) {
            const Point2 p{a.x + i / 300.0 * (b.x - a.x), a.y + i / 300.0 * (b.y - a.y)};
            if (Box2::of(p).meets(whole)) {
                ++inside;
                ASSERT_TRUE(contains(cells, grid.cell(p))) << round;
            }
        }
        std::sort(cells.begin(), cells.end());
        ASSERT_EQ(std::adjacent_find(cells.begin(), cells.end()), cells.end()) << "a cell came twice";
    }
    EXPECT_GT(inside, 5000);
}

TEST(Grid, HasACellInCommonForBoxesThatMeet) {
    Random random(32);
    int intersections = 0;
    for (int round = 0; round < 500; ++round) {
        const Box2 whole = random_box(random, {0, 0, 100, 3});
        const Grid grid(whole, Grid::cell_size(whole, 60, 0));
        const Box2 a = random_box(random, whole);
        const Box2 b = random_box(random, whole);
        if (!a.meets(b))
            continue;
        ++intersections;
        const std::size_t corner = grid.cell({std::max(a.x0, b.x0), std::max(a.y0, b.y0)});
        ASSERT_TRUE(contains(of_box(grid, a), corner) && contains(of_box(grid, b), corner)) << round;
    }
    EXPECT_GT(intersections, 100);
}

TEST(Grid, IsCoveredByItsCellsWithoutOverlap) {
    const Box2 whole{-1.1, 7, 2.3, 7.9};
    const Grid grid(whole, 0.3);
    ASSERT_GT(grid.cells(), 20U);
    Random random(33);
    for (int i = 0; i < 2000; ++i) {
        const Point2 p{random.real(whole.x0, whole.x1), random.real(whole.y0, whole.y1)};
        int cells = 0;
        for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
            const Box2 box = grid.box(cell);
            cells += box.x0 <= p.x && p.x < box.x1 && box.y0 <= p.y && p.y < box.y1 ? 1 : 0;
        }
        ASSERT_EQ(cells, 1);
    }
}

TEST(Grid, GivesTheThingsOfACellInTheOrderInWhichTheyCame) {
    const Box2 whole{0, 0, 3, 3};
    Grid grid(whole, 1);
    const std::vector<std::uint32_t> numbers{7, 2, 9};
    const auto box = [](std::uint32_t number) {
        return number == 2 ? Box2{0, 0, 2.5, 0} : Box2{0, 0, 0, 0};
    };
    const auto cells = [&](std::uint32_t number, const auto& visit) {
        grid.for_cells(box(number), visit);
    };
    const auto holds = [&](const Point2& place, const std::vector<std::uint32_t>& expected) {
        const auto found = grid.in_cell(grid.cell(place));
        return std::equal(found.begin(), found.end(), expected.begin(), expected.end());
    };
    ASSERT_TRUE(grid.sort(numbers, 5, cells));
    EXPECT_TRUE(holds({0, 0}, numbers));
    EXPECT_TRUE(holds({2.5, 0}, {2}));
    EXPECT_TRUE(grid.in_cell(grid.cell({0, 2})).empty());
    EXPECT_FALSE(grid.sort(numbers, 4, cells)) << "these are five entries";
}

TEST(Grid, HasAFewCellsForEachThingWhateverTheirPlaces) {
    for (const Box2& whole : {Box2{0, 0, 1, 1}, Box2{0, 0, 1000, 1e-3}, Box2{5, 0, 5, 70}})
        for (const double count : {1.0, 10.0, 1e4, 1e6}) {
            const Grid grid(whole, Grid::cell_size(whole, count, 0));
            EXPECT_LE(static_cast<double>(grid.cells()), 4 * count + 4);
        }
}

} // namespace
} // namespace lamella
