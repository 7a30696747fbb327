#include "parts/monotone_polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace lamella {
namespace {

using Chain = std::vector<NamedPoint>;

std::int64_t twice_area(const NamedPoint& a, const NamedPoint& b, const NamedPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Every triangle has a positive area, their number is right and their areas add up to the polygon's: then
/// they cover it exactly once.
void expect_triangulation(const Chain& lower, const Chain& upper) {
    std::map<std::uint32_t, NamedPoint> points;
    Chain ring = lower;
    for (std::size_t i = upper.size(); i-- > 0;)
        if (!(upper[i] == ring.back()) && !(upper[i] == ring.front()))
            ring.push_back(upper[i]);
    for (const NamedPoint& p : ring)
        points[p.id] = p;
    std::int64_t expected = 0;
    for (std::size_t i = 0; i < ring.size(); ++i)
        expected += twice_area({0, 0, 0}, ring[i], ring[(i + 1) % ring.size()]);

    const auto triangles = triangulate_monotone(lower, upper);
    EXPECT_EQ(triangles.size(), ring.size() - 2);
    std::int64_t sum = 0;
    for (const auto& t : triangles) {
        const std::int64_t area = twice_area(points.at(t[0]), points.at(t[1]), points.at(t[2]));
        EXPECT_GT(area, 0);
        sum += area;
    }
    EXPECT_EQ(sum, expected);
}

TEST(MonotonePolygon, TriangulatesATriangle) {
    expect_triangulation({{0, 0, 0}, {5, -1, 1}, {9, 0, 2}}, {{0, 0, 0}, {9, 0, 2}});
    expect_triangulation({{0, 0, 0}, {9, 0, 2}}, {{0, 0, 0}, {5, 1, 1}, {9, 0, 2}});
    expect_triangulation({{0, 0, 0}, {9, 0, 2}}, {{0, 3, 1}, {9, 0, 2}});
}

TEST(MonotonePolygon, TriangulatesPolygonsThatEndInEdges) {
    expect_triangulation({{0, 0, 0}, {9, 0, 1}}, {{0, 5, 2}, {9, 5, 3}});
    expect_triangulation({{0, 0, 0}, {9, 0, 1}}, {{1, 5, 2}, {11, 5, 3}});
    expect_triangulation({{2, 0, 0}, {9, 0, 1}}, {{1, 5, 2}, {3, 4, 4}, {5, 6, 5}, {7, 5, 3}});
}

TEST(MonotonePolygon, DegenerateChainsYieldNothing) {
    EXPECT_TRUE(triangulate_monotone({}, {}).empty());
    const Chain edge{{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(triangulate_monotone(edge, edge).empty());
}

TEST(MonotonePolygon, TriangulatesRandomZigzags) {
    std::mt19937 random(7);
    for (int round = 0; round < 500; ++round) {
        const auto chain = [&](std::int64_t low, std::int64_t high, std::uint32_t first_id) {
            Chain out;
            std::int64_t x = static_cast<std::int64_t>(random() % 5);
            const std::size_t n = 2 + random() % 20;
            while (out.size() < n) {
                out.push_back({x, low + static_cast<std::int64_t>(random()) % (high - low),
                               first_id + static_cast<std::uint32_t>(out.size())});
                x += 1 + static_cast<std::int64_t>(random() % 7);
            }
            return out;
        };
        Chain lower = chain(-1000, 0, 0);
        Chain upper = chain(1, 1000, 1000);
        if (round % 2 == 0) { // common ends
            const NamedPoint first{-1, static_cast<std::int64_t>(random() % 100), 2000};
            const NamedPoint last{1000, static_cast<std::int64_t>(random() % 100), 2001};
            for (Chain* c : {&lower, &upper}) {
                c->insert(c->begin(), first);
                c->push_back(last);
            }
            // Common ends may lie beyond the other chain's first edge: keep the polygon simple.
            for (NamedPoint& p : lower)
                p.y = p.id < 1000 ? p.y - 200000 : p.y;
            for (NamedPoint& p : upper)
                p.y = p.id < 2000 ? p.y + 200000 : p.y;
        } else { // ends that are vertical edges
            lower.front().x = upper.front().x = -1;
            lower.back().x = upper.back().x = 1000;
        }
        expect_triangulation(lower, upper);
    }
}

} // namespace
} // namespace lamella
