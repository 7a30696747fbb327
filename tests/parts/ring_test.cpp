#include "lamella/core/unit_circle.hpp"

#include "parts/ring.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace lamella {
namespace {

std::vector<Point2> polygon(unsigned corners, unsigned turned, double radius) {
    std::vector<Point2> out(corners);
    for (unsigned i = 0; i < corners; ++i) {
        const CosSin at = cos_sin_turn(60 * std::uint64_t{i} + turned, 60 * std::uint64_t{corners});
        out[i] = {radius * at.cos, radius * at.sin};
    }
    return out;
}

double doubled_area(const Point2& a, const Point2& b, const Point2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double doubled_area(const std::vector<Point2>& p) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i)
        sum += doubled_area(p[0], p[i], p[i + 1]);
    return sum;
}

TEST(Ring, IsCoveredOnceByTrianglesThatTurnLeft) {
    for (const unsigned outside : {3U, 4U, 5U, 12U})
        for (const unsigned inside : {3U, 4U, 6U, 31U})
            for (const unsigned turned : {0U, 7U, 15U, 30U}) {
                const std::vector<Point2> outer = polygon(outside, 0, 1);
                const std::vector<Point2> inner = polygon(inside, turned, 0.49);
                std::vector<Point2> corners = outer;
                corners.insert(corners.end(), inner.begin(), inner.end());
                const auto triangles = triangulate_ring(outer, inner);
                EXPECT_EQ(triangles.size(), outside + inside);
                double sum = 0;
                for (const auto& t : triangles) {
                    const double area = doubled_area(corners[t[0]], corners[t[1]], corners[t[2]]);
                    EXPECT_GT(area, 0) << outside << ' ' << inside << ' ' << turned;
                    sum += area;
                }
                EXPECT_NEAR(sum, doubled_area(outer) - doubled_area(inner), 1e-12);
            }
}

} // namespace
} // namespace lamella
