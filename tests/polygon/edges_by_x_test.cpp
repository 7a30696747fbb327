#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/edges_by_x.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::edges_by_x_cases {
namespace {

using test::Random;

/// An edge with small whole coordinates, so that all comparisons are exact.
RingEdge random_edge(Random& random, std::int64_t range) {
    const std::int64_t x = random.integer(0, range - 1);
    const auto lo_y = static_cast<double>(random.integer(0, range));
    const auto hi_x = static_cast<double>(random.integer(x + 1, range));
    const Segment line{{static_cast<double>(x), lo_y}, {hi_x, static_cast<double>(random.integer(0, range))}};
    return {line,
            static_cast<std::uint32_t>(random.integer(0, 4)),
            {random.integer(-1, 1), 0},
            random.integer(-3, 2)};
}

/// Compares heights of two edges at x, then their slopes, in whole numbers.
int compare(double x, const Segment& s, const Segment& t) {
    const double s_width = s.hi.x - s.lo.x;
    const double t_width = t.hi.x - t.lo.x;
    const double s_rise = s.hi.y - s.lo.y;
    const double t_rise = t.hi.y - t.lo.y;
    const double height = (s.lo.y * s_width + (x - s.lo.x) * s_rise) * t_width -
                          (t.lo.y * t_width + (x - t.lo.x) * t_rise) * s_width;
    const double slope = s_rise * t_width - t_rise * s_width;
    const double order = height != 0 ? height : slope;
    return order < 0 ? -1 : order > 0 ? 1 : 0;
}

bool is_below(double x, const RingEdge& a, const RingEdge& b) {
    const int order = compare(x, a.line, b.line);
    return order < 0 || (order == 0 && a.order < b.order);
}

TEST(EdgesByX, AgreesWithALoopOverAllEdges) {
    Random random(261);
    std::size_t loose = 0;
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const std::int64_t range = round % 2 == 0 ? 6 : 30;
        std::vector<double> values;
        for (std::int64_t n = random.integer(1, 9); n > 0; --n)
            values.push_back(static_cast<double>(random.integer(0, range)));
        EdgesByX tree(values);
        std::vector<RingEdge> edges;
        for (std::int64_t n = random.integer(0, 30); n > 0; --n) {
            const RingEdge edge = random_edge(random, range);
            const std::size_t first = tree.leaf(edge.line.lo.x, 0);
            const std::size_t end = tree.leaf(edge.line.hi.x, first);
            if (first == end)
                continue; // it spans none of the values
            edges.push_back(edge);
            tree.add(edge, first, end);
        }
        tree.order();
        for (const double x : values) {
            RingEdge query = random_edge(random, range);
            query.line.lo.x = std::min(query.line.lo.x, x);
            query.line.hi.x = std::max(query.line.hi.x, x + 1);
            Windings winding;
            std::int64_t equal = 0;
            const RingEdge* best = nullptr;
            tree.for_columns_at(x, [&](const EdgeColumn& column) {
                winding += column.winding_below(x, query);
                equal += column.count_equal(x, query);
                column.raise(x, query, best);
                loose += column.loose();
            });
            Windings expected;
            std::int64_t expected_equal = 0;
            const RingEdge* highest = nullptr;
            for (const RingEdge& edge : edges) {
                if (edge.line.lo.x > x || edge.line.hi.x <= x)
                    continue;
                if (compare(x, edge.line, query.line) == 0 && edge.order == query.order)
                    ++expected_equal;
                if (!is_below(x, edge, query))
                    continue;
                expected += edge.step;
                if (highest == nullptr || is_below(x, *highest, edge))
                    highest = &edge;
            }
            EXPECT_EQ(winding, expected) << round;
            EXPECT_EQ(equal, expected_equal) << round;
            ASSERT_EQ(best == nullptr, highest == nullptr) << round;
            if (best != nullptr) {
                EXPECT_FALSE(is_below(x, *best, *highest) || is_below(x, *highest, *best)) << round;
            }
        }
    }
    EXPECT_GT(loose, test::slowed ? 0U : 100U) << "some edges cross";
}

TEST(EdgesByX, NumbersLeavesByTheValuesBelow) {
    const EdgesByX tree({5, 1, 3, 3});
    for (const std::size_t near : {0, 1, 2, 3}) {
        EXPECT_EQ(tree.leaf(0, near), 0U);
        EXPECT_EQ(tree.leaf(1, near), 0U);
        EXPECT_EQ(tree.leaf(3, near), 1U);
        EXPECT_EQ(tree.leaf(4, near), 2U);
        EXPECT_EQ(tree.leaf(5, near), 2U);
        EXPECT_EQ(tree.leaf(6, near), 3U);
    }
}

} // namespace
} // namespace lamella::edges_by_x_cases
