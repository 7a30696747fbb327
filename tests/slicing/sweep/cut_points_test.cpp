#include "core/pages.hpp"
#include "slicing/edge_cut.hpp"
#include "slicing/sweep/cut_points.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lamella {
namespace {

using Points = std::vector<Point2>;

/// The points of upright edges.
CutPoints through(const Points& points) {
    const std::size_t stride = EdgeColumns::padded(points.size());
    const PageArray<double> columns(EdgeColumns::columns * stride, Fill::zero);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const EdgeCut edge({points[i].x, points[i].y, 0}, {points[i].x, points[i].y, 1});
        const double values[]{edge.z0, edge.inverse_dz, edge.x0, edge.dx, edge.y0, edge.dy};
        for (std::size_t c = 0; c < EdgeColumns::columns; ++c)
            columns[c * stride + i] = values[c];
    }
    CutPoints cut;
    cut.compute({columns.data(), points.size()}, 0.5);
    return cut;
}

Points list(const CutPoints& cut) {
    Points points(cut.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = cut[i];
    return points;
}

TEST(CutPoints, LoseThoseThatEqualTheOneBefore) {
    const Points points{{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 0}};
    CutPoints chain = through(points);
    EXPECT_EQ(list(chain), points);
    EXPECT_EQ(chain.squared_closing(), 0.0);
    chain.drop_repeats(false);
    EXPECT_EQ(list(chain), (Points{{0, 0}, {1, 0}, {1, 1}, {0, 0}}));
    CutPoints ring = through(points);
    ring.drop_repeats(true);
    EXPECT_EQ(list(ring), (Points{{0, 0}, {1, 0}, {1, 1}}));
    EXPECT_EQ(ring.squared_closing(), 2.0);
}

TEST(CutPoints, StartAtTheLeftmost) {
    const RingStart start = through({{2, 0}, {1, 1}, {0.5, 0}, {1, -1}}).start(0.5, 0.25, false);
    EXPECT_EQ(start.index, 2U);
    EXPECT_TRUE(start.alone);
    EXPECT_FALSE(start.flat);
}

TEST(CutPoints, StartAtTheLeftmostThoughOthersAreWithinTheTolerance) {
    const RingStart start =
        through({{0.75, 0}, {2, 0}, {2, 5}, {0.625, 4}, {0.5, 2}}).start(0.5, 0.25, false);
    EXPECT_EQ(start.index, 4U);
    EXPECT_FALSE(start.alone);
    EXPECT_FALSE(start.flat);
}

TEST(CutPoints, StartAtTheLowestOfTheLeftmost) {
    const RingStart start = through({{0, 3}, {0, 1}, {0, 0}, {4, 0}, {4, 4}}).start(0, 0, false);
    EXPECT_EQ(start.index, 2U);
    EXPECT_FALSE(start.alone);
}

TEST(CutPoints, StartWhereTheSmallestSequenceDoes) {
    // Passes through its leftmost point twice.
    const RingStart start = through({{0, 0}, {2, 1}, {2, 2}, {0, 0}, {1, -2}, {2, -1}}).start(0, 0, false);
    EXPECT_EQ(start.index, 3U);
    EXPECT_FALSE(start.flat);
}

TEST(CutPoints, KnowALine) {
    EXPECT_TRUE(through({{0, 0}, {1, 1}, {3, 3}, {2, 2}}).start(0, 1e-9, false).flat);
    // Out and back by another way than a line, along the same points.
    EXPECT_TRUE(through({{0, 0}, {1, 1}, {3, 0}, {1, 1}}).start(0, 1e-9, false).flat);
    // A fin, not all of the ring.
    EXPECT_FALSE(through({{0, 0}, {1, 0}, {2, 1}, {2, -1}, {1, 0}}).start(0, 1e-9, false).flat);
}

} // namespace
} // namespace lamella
