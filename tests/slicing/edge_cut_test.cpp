#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "slicing/edge_cut.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lamella {
namespace {

std::uint64_t bits(double v) {
    return std::bit_cast<std::uint64_t>(v);
}

void expect_same_bits(const Point2& a, const Point2& b) {
    EXPECT_EQ(bits(a.x), bits(b.x));
    EXPECT_EQ(bits(a.y), bits(b.y));
}

double ulp(double v) {
    const double size = std::abs(v);
    return std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
}

/// A number of any sign whose size is spread evenly over the binades 2^first to 2^last.
double any_size(test::Random& random, int first, int last) {
    return std::ldexp(random.real(-1, 1), static_cast<int>(random.integer(first, last)));
}

/// Ends as meshes have them: some coordinates shared, some nearly equal, all sizes mixed.
std::pair<Point3, Point3> any_edge(test::Random& random, int first, int last) {
    Point3 a{any_size(random, first, last), any_size(random, first, last), any_size(random, first, last)};
    Point3 b{any_size(random, first, last), any_size(random, first, last), any_size(random, first, last)};
    const auto nearly = [&](double& to, double from) {
        const std::int64_t kind = random.integer(0, 5);
        if (kind == 0)
            to = from;
        else if (kind == 1)
            to = std::nextafter(from, to);
        else if (kind == 2)
            to = from + from * random.real(-1e-12, 1e-12);
    };
    nearly(b.x, a.x);
    nearly(b.y, a.y);
    nearly(b.z, a.z);
    if (a.z == b.z)
        b.z = std::nextafter(a.z, 4.0);
    return {a, b};
}

/// Heights on the edge: both ends, their neighbours and some between.
std::vector<double> heights_on(test::Random& random, double from, double to) {
    std::vector<double> z{from, to, std::nextafter(from, to), std::nextafter(to, from)};
    for (int i = 0; i < 6; ++i) {
        const double s = random.real(0, 1);
        z.push_back(std::clamp(from * (1 - s) + to * s, std::min(from, to), std::max(from, to)));
    }
    return z;
}

void expect_inside(const Point2& p, const Point3& a, const Point3& b) {
    ASSERT_LE(std::min(a.x, b.x), p.x);
    ASSERT_GE(std::max(a.x, b.x), p.x);
    ASSERT_LE(std::min(a.y, b.y), p.y);
    ASSERT_GE(std::max(a.y, b.y), p.y);
}

TEST(EdgeCut, IsTheBaseBitForBitOnAPlaneThroughTheBase) {
    test::Random random(10);
    for (int i = 0; i < test::rounds_within_reason(200000); ++i) {
        const auto [a, b] = any_edge(random, -60, 60);
        expect_same_bits(EdgeCut(a, b).at(a.z), {a.x, a.y});
        expect_same_bits(EdgeCut(b, a).at(b.z), {b.x, b.y});
    }
}

TEST(EdgeCut, IsTheBaseOnAPlaneWithinTheSnapDistanceAndTheSameAsWithoutOneElsewhere) {
    test::Random random(15);
    for (int i = 0; i < test::rounds_within_reason(20000); ++i) {
        auto [a, b] = any_edge(random, -20, 20);
        a.z = random.real(-8, 8); // so that heights between differ by more than rounding
        b.z = a.z + (random.integer(0, 1) == 0 ? 1 : -1) * random.real(0.1, 4);
        const double snap = std::abs(b.z - a.z) * random.real(0, 0.5);
        for (const double share : {-0.999, -0.5, 0.0, 0.5, 0.999}) {
            expect_same_bits(EdgeCut(a, b, snap).at(a.z + share * snap), {a.x, a.y});
            expect_same_bits(EdgeCut(b, a, snap).at(b.z + share * snap), {b.x, b.y});
        }
        const double z = a.z + (b.z - a.z) * random.real(0.51, 1);
        expect_same_bits(EdgeCut(a, b, snap).at(z), EdgeCut(a, b).at(z));
    }
}

void expect_all_inside(test::Random& random, const Point3& a, const Point3& b) {
    for (const double z : heights_on(random, a.z, b.z)) {
        expect_inside(EdgeCut(a, b).at(z), a, b);
        expect_inside(EdgeCut(b, a).at(z), a, b);
    }
}

TEST(EdgeCut, NeverLeavesTheBoxOfTheEdge) {
    test::Random random(11);
    for (int i = 0; i < test::rounds_within_reason(200000); ++i) {
        const auto [a, b] = any_edge(random, -60, 60);
        expect_all_inside(random, a, b);
    }
}

TEST(EdgeCut, NeverLeavesTheBoxOfAnEdgeOfAnySize) {
    test::Random random(12);
    for (int i = 0; i < test::rounds_within_reason(200000); ++i) {
        const auto [a, b] = any_edge(random, -1074, 1022);
        expect_all_inside(random, a, b);
    }
}

TEST(EdgeCut, NeverLeavesTheBoxOfAnEdgeThatIsAlmostLevel) {
    test::Random random(13);
    for (int i = 0; i < test::rounds_within_reason(100000); ++i) {
        auto [a, b] = any_edge(random, -10, 10);
        a.z = any_size(random, -1074, -1020);
        b.z = a.z + static_cast<double>(random.integer(1, 5)) * 5e-324;
        expect_all_inside(random, a, b);
    }
}

TEST(EdgeCut, ReachesTheFarEndUpToRounding) {
    test::Random random(14);
    for (int i = 0; i < test::rounds_within_reason(100000); ++i) {
        const auto [a, b] = any_edge(random, -30, 30);
        const Point2 p = EdgeCut(a, b).at(b.z);
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        ASSERT_NEAR(p.x, b.x, 6 * ulp(dx) + ulp(std::max(std::abs(a.x), std::abs(b.x))) / 2);
        ASSERT_NEAR(p.y, b.y, 6 * ulp(dy) + ulp(std::max(std::abs(a.y), std::abs(b.y))) / 2);
    }
}

TEST(EdgeCut, ErrsByNoMoreThanItsStatedBound) {
    test::Random random(15);
    for (int i = 0; i < test::rounds_within_reason(300000); ++i) {
        const auto [a, b] = any_edge(random, -30, 30);
        const EdgeCut cut(a, b);
        for (const double z : heights_on(random, a.z, b.z)) {
            const long double t = (static_cast<long double>(z) - a.z) / (static_cast<long double>(b.z) - a.z);
            const Point2 p = cut.at(z);
            const auto error = [&](double from, double to, double found) {
                const long double exact = from + t * (static_cast<long double>(to) - from);
                return static_cast<double>(std::abs(found - exact));
            };
            ASSERT_LE(error(a.x, b.x, p.x), 6 * ulp(b.x - a.x) + ulp(p.x) / 2);
            ASSERT_LE(error(a.y, b.y, p.y), 6 * ulp(b.y - a.y) + ulp(p.y) / 2);
        }
    }
}

TEST(EdgeCut, DoesNotTurnBackAsThePlaneRises) {
    test::Random random(16);
    for (int i = 0; i < test::rounds_within_reason(20000); ++i) {
        const auto [a, b] = any_edge(random, -30, 30);
        const bool up = a.z < b.z;
        std::vector<double> z = heights_on(random, a.z, b.z);
        std::sort(z.begin(), z.end());
        const EdgeCut cut = EdgeCut(a, b);
        for (std::size_t k = 1; k < z.size(); ++k) {
            const Point2 p = cut.at(up ? z[k - 1] : z[k]);
            const Point2 q = cut.at(up ? z[k] : z[k - 1]);
            ASSERT_TRUE(a.x <= b.x ? p.x <= q.x : p.x >= q.x);
            ASSERT_TRUE(a.y <= b.y ? p.y <= q.y : p.y >= q.y);
        }
    }
}

TEST(EdgeCut, OfAVerticalEdgeIsItsFootOnEveryPlane) {
    const EdgeCut cut({0.1, -0.7, -3}, {0.1, -0.7, 1e6});
    for (const double z : {-3.0, -2.999, 0.0, 12345.678, 1e6})
        expect_same_bits(cut.at(z), {0.1, -0.7});
}

TEST(EdgeCut, NeverGivesMinusZero) {
    for (const double from : {-0.0, 0.0})
        for (const double to : {-1.0, -0.0, 0.0, 1.0})
            for (const double z : {0.0, -0.0, 0.5, 1.0}) {
                const Point2 p = EdgeCut({from, from, 0}, {to, to, 1}).at(z);
                EXPECT_FALSE(p.x == 0 && std::signbit(p.x)) << from << " to " << to << " at " << z;
                EXPECT_FALSE(p.y == 0 && std::signbit(p.y)) << from << " to " << to << " at " << z;
            }
}

TEST(EdgeCut, OfAnEdgeTooFlatToDivideByIsItsFarEnd) {
    const Point3 low{1, 2, 0};
    const Point3 high{5, -4, 5e-324};
    const Point2 p = EdgeCut(low, high).at(0);
    EXPECT_EQ(p.x, 5.0);
    EXPECT_EQ(p.y, -4.0);
    const Point2 q = EdgeCut(high, low).at(5e-324);
    EXPECT_EQ(q.x, 1.0);
    EXPECT_EQ(q.y, 2.0);
}

} // namespace
} // namespace lamella
