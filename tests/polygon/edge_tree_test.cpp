#include "fixtures/layers.hpp"
#include "polygon/edge_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace lamella {
namespace {

using test::layer_of;
using test::rectangle;
using test::reversed;

double squared(const Point2& a, const Point2& b) {
    return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

TEST(EdgeTree, OfNothingIsInfinitelyFar) {
    const EdgeTree tree(Layer{});
    EXPECT_TRUE(tree.empty());
    EXPECT_EQ(tree.distance_squared(Point2{1, 2}, 0), std::numeric_limits<double>::infinity());
    EXPECT_EQ(tree.distance_squared(Segment{{1, 2}, {3, 4}}, 0), std::numeric_limits<double>::infinity());
    EXPECT_EQ(tree.winding({1, 2}), 0);
}

TEST(EdgeTree, ReportsDistancesAndWindings) {
    const EdgeTree tree(layer_of({rectangle(0, 0, 10, 10), reversed(rectangle(4, 4, 6, 6))}));
    EXPECT_EQ(tree.distance_squared(Point2{2, 5}, 0), 4);
    EXPECT_EQ(tree.distance_squared(Segment{{1, 5}, {3, 5}}, 0), 1);
    EXPECT_EQ(tree.distance_squared(Segment{{1, 2}, {9, 2}}, 0), 1) << "an end is nearer than the hole";
    EXPECT_EQ(tree.distance_squared(Segment{{2, 3}, {8, 3}}, 0), 1) << "the hole is nearer than the ends";
    EXPECT_EQ(tree.distance_squared(Segment{{1, 5}, {9, 5}}, 0), 0) << "it leads across the hole";
    EXPECT_EQ(tree.distance_squared(Segment{{12, 13}, {13, 14}}, 0), 13);
    EXPECT_EQ(tree.winding({2, 2}), 1);
    EXPECT_EQ(tree.winding({5, 5}), 0);
    EXPECT_EQ(tree.winding({11, 5}), 0);
    EXPECT_EQ(tree.winding({0, 0}), 1) << "what is above and to the right of a point counts";
    EXPECT_EQ(tree.winding({10, 10}), 0);
    EXPECT_EQ(tree.winding({4, 4}), 0);
    EXPECT_EQ(tree.winding({6, 6}), 1);
}

TEST(EdgeTree, AgreesWithLookingAtAllEdges) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> of_grid(0, 12);
    const auto point = [&] {
        return Point2{static_cast<double>(of_grid(random)), static_cast<double>(of_grid(random))};
    };
    for (int round = 0; round < 200; ++round) {
        std::vector<test::Contour> rings(8);
        for (test::Contour& ring : rings)
            for (int i = 0; i < 5; ++i)
                ring.push_back(point());
        const Layer layer = layer_of(rings);
        const EdgeTree tree(layer);
        for (int query = 0; query < 20; ++query) {
            const Point2 a = point();
            const Point2 b = point();
            // By sampling: never nearer than the tree says, and nearly as near.
            double nearest = std::numeric_limits<double>::infinity();
            constexpr int samples = 60;
            for (std::size_t i = 0; i < layer.contours(); ++i) {
                const auto ring = layer.contour(i);
                for (std::size_t k = 0; k < ring.size(); ++k) {
                    const Point2& p = ring[k];
                    const Point2& q = ring[(k + 1) % ring.size()];
                    for (int s = 0; s <= samples; ++s)
                        for (int t = 0; t <= samples; t += samples / 4) {
                            const double u = s / static_cast<double>(samples);
                            const double v = t / static_cast<double>(samples);
                            nearest =
                                std::min(nearest, squared({a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)},
                                                          {p.x + v * (q.x - p.x), p.y + v * (q.y - p.y)}));
                        }
                }
            }
            const double found = std::sqrt(tree.distance_squared(segment_between(a, b), 0));
            EXPECT_LE(found, std::sqrt(nearest) + 1e-12);
            EXPECT_GE(found, std::sqrt(nearest) - 2.2);
            EXPECT_EQ(tree.distance_squared(a, 0), tree.distance_squared(Segment{a, a}, 0));
        }
    }
}

TEST(EdgeTree, ManyPointsWindAsTheAngleSays) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(0, 10);
    for (int round = 0; round < 100; ++round) {
        std::vector<test::Contour> rings(5);
        for (test::Contour& ring : rings)
            for (int i = 0; i < 7; ++i)
                ring.push_back({place(random), place(random)});
        const Layer layer = layer_of(rings);
        const EdgeTree tree(layer);
        for (int query = 0; query < 20; ++query) {
            const Point2 p{place(random), place(random)};
            double angle = 0;
            for (std::size_t i = 0; i < layer.contours(); ++i) {
                const auto ring = layer.contour(i);
                for (std::size_t k = 0; k < ring.size(); ++k) {
                    const Point2 a{ring[k].x - p.x, ring[k].y - p.y};
                    const Point2& next = ring[(k + 1) % ring.size()];
                    const Point2 b{next.x - p.x, next.y - p.y};
                    angle += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
                }
            }
            EXPECT_EQ(tree.winding(p), std::lround(angle / (2 * std::acos(-1.0))));
        }
    }
}

} // namespace
} // namespace lamella
