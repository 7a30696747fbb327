#include "lamella/mesh/transform.hpp"

#include "core/orientation.hpp"
#include "fixtures/random.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "mesh/polygon_triangulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace lamella {
namespace {

using test::Random;
using Polygon = std::vector<Point2>;
using Triangle = PolygonTriangulator::Triangle;

std::vector<Triangle> triangles_of(const std::vector<Point3>& corners) {
    PolygonTriangulator triangulator;
    const std::span<const Triangle> triangles = triangulator.triangulate(corners);
    return {triangles.begin(), triangles.end()};
}

std::vector<Point3> level(const Polygon& polygon) {
    std::vector<Point3> corners;
    for (const Point2& p : polygon)
        corners.push_back({p.x, p.y, 5});
    return corners;
}

/// n - 2 triangles; the edges of the polygon once, all others once in either direction.
void expect_closed(const std::vector<Triangle>& triangles, std::size_t n) {
    ASSERT_EQ(triangles.size(), n - 2);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LT(t[k], n);
            ++uses[{t[k], t[(k + 1) % 3]}];
        }
    for (std::uint32_t i = 0; i < n; ++i)
        --uses[{i, (i + 1) % static_cast<std::uint32_t>(n)}];
    for (const auto& [edge, count] : uses)
        EXPECT_EQ(count, (uses.contains({edge.second, edge.first}) ? uses.at({edge.second, edge.first}) : 0))
            << edge.first << ' ' << edge.second;
}

/// Signed areas of triangles add up to that of the polygon whatever they are; where none is negative, each
/// place of a polygon that does not cross itself is covered once.
void expect_triangulated(const Polygon& polygon) {
    const std::vector<Triangle> triangles = triangles_of(level(polygon));
    expect_closed(triangles, polygon.size());
    for (const Triangle& t : triangles)
        ASSERT_GE(orientation(polygon[t[0]], polygon[t[1]], polygon[t[2]]), 0)
            << t[0] << ' ' << t[1] << ' ' << t[2];
}

/// Star-shaped, as seen from the origin.
Polygon star(Random& random, std::size_t corners, double smallest) {
    Polygon polygon;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = random.real(smallest, 1);
        polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return polygon;
}

/// Teeth of random height, upwards from y = 0.
Polygon saw(Random& random, std::size_t teeth) {
    Polygon polygon{{0, -1}, {static_cast<double>(2 * teeth), -1}};
    for (std::size_t i = 2 * teeth; i > 0; --i)
        polygon.push_back({static_cast<double>(i) - 0.5, i % 2 == 0 ? 0 : random.real(0.1, 1000)});
    return polygon;
}

/// A band that winds inwards, with integer coordinates.
Polygon spiral(int turns) {
    Polygon outside;
    Polygon inside;
    for (int i = 0; i < 4 * turns; ++i) {
        const double far = 4 * turns - i;
        const double near = far - 1;
        const std::array<Point2, 4> directions{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
        const Point2 d = directions[i % 4];
        outside.push_back({d.x * far, d.y * far});
        inside.push_back({d.x * near, d.y * near});
    }
    std::reverse(inside.begin(), inside.end());
    outside.insert(outside.end(), inside.begin(), inside.end());
    return outside;
}

/// A rectangle with square holes in a row, each hung on the hole before it, the first on the outline.
Polygon with_holes(int holes) {
    Polygon polygon{{0, 0}};
    for (int i = 0; i < holes; ++i) {
        const double x = 3 * i + 1;
        polygon.insert(polygon.end(), {{x, 1}, {x, 2}, {x + 1, 2}, {x + 1, 1}});
    }
    for (int i = holes; i-- > 0;) {
        const double x = 3 * i + 1;
        if (i + 1 != holes)
            polygon.push_back({x + 1, 1}); // the bridge ends here
        polygon.push_back({x, 1});
    }
    const double width = 3 * holes + 2;
    polygon.insert(polygon.end(), {{0, 0}, {width, 0}, {width, 4}, {0, 4}});
    return polygon;
}

TEST(PolygonTriangulation, MakesAFanOfAConvexPolygon) {
    EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<Triangle>{{0, 1, 2}}));
    EXPECT_EQ(triangles_of(level({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}})),
              (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    // Seen from below.
    EXPECT_EQ(triangles_of(level({{0, 0}, {0, 2}, {2, 2}, {2, 0}})),
              (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(PolygonTriangulation, GivesNothingForFewerThanThreeCorners) {
    EXPECT_TRUE(triangles_of({}).empty());
    EXPECT_TRUE(triangles_of({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST(PolygonTriangulation, CutsAnArrowheadAtItsNotch) {
    const std::vector<Triangle> triangles = triangles_of(level({{0, 0}, {2, -3}, {1, 0}, {2, 3}}));
    ASSERT_EQ(triangles.size(), 2U);
    for (const Triangle& t : triangles)
        EXPECT_TRUE(std::find(t.begin(), t.end(), 0U) != t.end() &&
                    std::find(t.begin(), t.end(), 2U) != t.end());
}

TEST(PolygonTriangulation, OfRandomConcavePolygonsFlipsNothing) {
    Random random(1);
    for (int round = 0; round < 2000; ++round)
        expect_triangulated(star(random, static_cast<std::size_t>(random.integer(4, 60)), 0.05));
}

TEST(PolygonTriangulation, OfLargePolygonsFlipsNothing) {
    Random random(2);
    expect_triangulated(star(random, 20'000, 0.5));
    expect_triangulated(star(random, 20'000, 0.001));
    expect_triangulated(saw(random, 10'000));
    expect_triangulated(spiral(1'000));
}

TEST(PolygonTriangulation, TakesHolesThatHangOnBridges) {
    for (const int holes : {1, 2, 3, 10, 500})
        expect_triangulated(with_holes(holes));
}

TEST(PolygonTriangulation, TakesCollinearAndRepeatedCorners) {
    // A square with corners along its sides.
    Polygon square;
    for (int i = 0; i < 10; ++i)
        square.push_back({static_cast<double>(i), 0});
    for (int i = 0; i < 10; ++i)
        square.push_back({10, static_cast<double>(i)});
    for (int i = 10; i > 0; --i)
        square.push_back({static_cast<double>(i), 10});
    for (int i = 10; i > 0; --i)
        square.push_back({0, static_cast<double>(i)});
    expect_triangulated(square);
    // None of its triangles needs to be without area.
    for (const Triangle& t : triangles_of(level(square)))
        EXPECT_GT(orientation(square[t[0]], square[t[1]], square[t[2]]), 0);

    Polygon twice;
    for (const Point2& p : square)
        twice.insert(twice.end(), {p, p});
    expect_triangulated(twice);

    // All on a line; a needle there and back; all in one point.
    expect_triangulated({{0, 0}, {1, 1}, {2, 2}, {5, 5}, {3, 3}});
    expect_triangulated({{0, 0}, {4, 0}, {4, 4}, {4, 9}, {4, 4}, {0, 4}});
    expect_triangulated({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}});
    // Touches its own side from inside, in a corner.
    expect_triangulated({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}});
}

TEST(PolygonTriangulation, InAnyPlaneKeepsAreaAndDirection) {
    Random random(3);
    for (int round = 0; round < 1000; ++round) {
        const Polygon polygon = star(random, static_cast<std::size_t>(random.integer(4, 40)), 0.2);
        const Transform map =
            compose(translation(random.real(-1e3, 1e3), random.real(-1e3, 1e3), random.real(-1e3, 1e3)),
                    compose(rotation('x', random.real(0, 360)),
                            compose(rotation('z', random.real(0, 360)), scaling(50, 50, 50))));
        std::vector<Point3> corners;
        for (const Point2& p : polygon)
            corners.push_back(map({p.x, p.y, 0}));
        const Point3 up = map({0, 0, 0.02});
        const Point3 origin = map({0, 0, 0});
        const Point3 normal{up.x - origin.x, up.y - origin.y, up.z - origin.z};

        double expected = 0;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point2& a = polygon[i];
            const Point2& b = polygon[(i + 1) % polygon.size()];
            expected += (a.x * b.y - a.y * b.x) / 2 * 50 * 50;
        }
        double sum = 0;
        const std::vector<Triangle> triangles = triangles_of(corners);
        expect_closed(triangles, corners.size());
        for (const Triangle& t : triangles) {
            const auto edge = [&](int k) {
                const Point3& p = corners[t[k]];
                const Point3& q = corners[t[0]];
                return Point3{p.x - q.x, p.y - q.y, p.z - q.z};
            };
            const Point3 e = edge(1);
            const Point3 f = edge(2);
            const double area = ((e.y * f.z - e.z * f.y) * normal.x + (e.z * f.x - e.x * f.z) * normal.y +
                                 (e.x * f.y - e.y * f.x) * normal.z) /
                                2;
            EXPECT_GT(area, -1e-9);
            sum += area;
        }
        EXPECT_NEAR(sum, expected, 1e-8);
    }
}

TEST(PolygonTriangulation, SurvivesPolygonsThatCrossThemselves) {
    Random random(4);
    PolygonTriangulator triangulator;
    for (int round = 0; round < 3000; ++round) {
        const auto n = static_cast<std::size_t>(random.integer(4, 30));
        // Few different places, so that corners coincide and lie on edges.
        const std::int64_t places = round % 2 == 0 ? 3 : 1000;
        std::vector<Point3> corners(n);
        for (Point3& p : corners)
            p = {static_cast<double>(random.integer(0, places)),
                 static_cast<double>(random.integer(0, places)),
                 static_cast<double>(random.integer(0, places))};
        const std::span<const Triangle> triangles = triangulator.triangulate(corners);
        expect_closed({triangles.begin(), triangles.end()}, n);
    }
    // A star of five points turns left everywhere, and is not convex.
    expect_closed(triangles_of(level({{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}})), 5);
}

TEST(PolygonTriangulation, SurvivesTheLargestAndTheSmallestNumbers) {
    constexpr double most = std::numeric_limits<double>::max();
    constexpr double least = std::numeric_limits<double>::denorm_min();
    for (const double size : {most, least, 1e-300, 1e150})
        for (const double scale : {1.0, -1.0}) {
            const double s = size * scale;
            expect_closed(
                triangles_of({{0, 0, 0}, {s, -s, s}, {s, 0, s}, {0, 0, -s}, {s, s, s}, {-s, -s, 0}}), 6);
        }
}

TEST(PolygonTriangulation, EndsSoonOnAHostilePolygon) {
    LAMELLA_SKIP_IF_SLOWED();
    // Long spikes, all through the same few cells of the grid: every corner is in the way of every ear.
    Random random(5);
    std::vector<Point3> corners(100'000);
    for (std::size_t i = 0; i < corners.size(); ++i)
        corners[i] = {i % 2 == 0 ? random.real(0, 1e-6) : 1e6 + random.real(0, 1), random.real(0, 1), 0};
    corners[0] = {-1e9, 1e9, 0};
    EXPECT_EQ(triangles_of(corners).size(), corners.size() - 2);
}

} // namespace
} // namespace lamella
