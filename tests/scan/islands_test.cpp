#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "scan/islands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace lamella::islands_cases {
namespace {

using test::Random;

constexpr double cell_width = 5;

/// Squares of cells; the lines of each second one run across.
struct Chessboard {
    explicit Chessboard(const Layer& layer)
        : along(layer, {1, 0}, 0.5), across(layer, {0, 1}, 0.5), islands(1000, {}) {
        for (const HatchLines* lines : {&along, &across}) {
            islands.begin(*lines);
            for (std::size_t i = 0; i < lines->size(); ++i)
                for (std::size_t k = 0; k + 1 < lines->ends(i).size(); k += 2)
                    for (double from = lines->ends(i)[k]; from < lines->ends(i)[k + 1];) {
                        const double next = (std::floor(from / cell_width + 1e-9) + 1) * cell_width;
                        const double to = std::min(next, lines->ends(i)[k + 1]);
                        const Cell cell = cell_of(lines->frame().point((from + to) / 2, lines->v(i)));
                        if (((cell.row + cell.column) % 2 == 0) == (lines == &along)) {
                            islands.add(cell, i, from, to);
                            pieces.insert(ordered(lines->frame().point(from, lines->v(i)),
                                                  lines->frame().point(to, lines->v(i))));
                        }
                        from = to;
                    }
        }
    }

    static Cell cell_of(const Point2& p) {
        return {static_cast<std::int32_t>(std::floor(p.y / cell_width)),
                static_cast<std::int32_t>(std::floor(p.x / cell_width))};
    }
    static std::pair<Point2, Point2> ordered(const Point2& a, const Point2& b) { return std::minmax(a, b); }

    HatchLines along;
    HatchLines across;
    Islands islands;
    std::multiset<std::pair<Point2, Point2>> pieces;
};

/// The cells in their order; each is visited once, and its lines alternate in direction.
std::vector<Cell> expect_cell_by_cell(const PointArray& points,
                                      const std::multiset<std::pair<Point2, Point2>>& pieces) {
    std::multiset<std::pair<Point2, Point2>> found;
    std::vector<Cell> cells;
    std::set<Cell> visited;
    Point2 direction_before;
    for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
        const Point2& a = points[i];
        const Point2& b = points[i + 1];
        found.insert(Chessboard::ordered(a, b));
        const Cell cell = Chessboard::cell_of({(a.x + b.x) / 2, (a.y + b.y) / 2});
        const Point2 direction{b.x - a.x, b.y - a.y};
        if (cells.empty() || cells.back() != cell) {
            EXPECT_TRUE(visited.insert(cell).second) << "a cell is left before it is finished";
            cells.push_back(cell);
        } else {
            EXPECT_LT(direction.x * direction_before.x + direction.y * direction_before.y, 0);
        }
        direction_before = direction;
    }
    EXPECT_EQ(found, pieces) << "each piece once";
    return cells;
}

const Layer square = test::layer_of({test::rectangle(0.1, 0.1, 29.9, 24.9)});

TEST(Islands, InRowsGoForthAndBack) {
    Chessboard board(square);
    const std::vector<Cell> cells =
        expect_cell_by_cell(std::move(board.islands).points_in_rows(), board.pieces);
    ASSERT_EQ(cells.size(), 30U);
    for (std::size_t i = 1; i < cells.size(); ++i) {
        EXPECT_GE(cells[i].row, cells[i - 1].row);
        if (cells[i].row == cells[i - 1].row) {
            EXPECT_EQ(cells[i].column - cells[i - 1].column, cells[i].row % 2 == 0 ? 1 : -1);
        } else {
            EXPECT_EQ(cells[i].column, cells[i - 1].column)
                << "the next row begins beside the end of the last";
        }
    }
}

TEST(Islands, ShuffledFollowTheSeedAndTheLayer) {
    std::set<std::vector<Cell>> orders;
    for (const auto& [seed, layer] : {std::pair<std::uint64_t, std::uint64_t>{1, 1}, {1, 2}, {9, 1}}) {
        std::vector<std::vector<Cell>> same;
        for (int twice = 0; twice < 2; ++twice) {
            Chessboard board(square);
            same.push_back(
                expect_cell_by_cell(std::move(board.islands).points_shuffled(seed, layer), board.pieces));
        }
        EXPECT_EQ(same[0], same[1]);
        orders.insert(same[0]);
    }
    EXPECT_EQ(orders.size(), 3U);
}

TEST(Islands, OfNothingAreEmpty) {
    EXPECT_TRUE(Islands(0, {}).points_in_rows().empty());
    EXPECT_TRUE(Islands(0, {}).points_shuffled(1, 2).empty());
}

TEST(Islands, CountTheirMemoryBeforeTheyTakeIt) {
    const LayerBudget budget({.memory = 1000}, 3, 0.5);
    test::expect_error(ErrorKind::limit, {"layer 3", "hatch lines in stripes or islands", "`hatch.cell`"},
                       [&] { const Islands islands(1000, budget); });
}

} // namespace
} // namespace lamella::islands_cases
