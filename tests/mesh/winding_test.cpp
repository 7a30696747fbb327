#include "fixtures/random_solids.hpp"
#include "fixtures/rounds.hpp"
#include "mesh/assemble.hpp"
#include "mesh/solid_angle.hpp"
#include "mesh/winding.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace lamella::winding_cases {
namespace {

using test::Random;

/// Winding numbers of all points. Each triangle may be visited once for a point.
std::vector<int> windings(const IndexedMesh& mesh, const std::vector<Point3>& points, unsigned threads) {
    const Execution execution{.threads = threads};
    Executor executor(execution);
    std::vector<int> result(points.size(), 0);
    std::set<std::pair<std::size_t, std::size_t>> visited;
    std::mutex mutex;
    for_triangles_above(executor, mesh, points,
                        [&](std::size_t point, std::size_t triangle, int winding, unsigned worker) {
                            const std::lock_guard lock(mutex);
                            EXPECT_LT(worker, executor.workers());
                            EXPECT_EQ(std::abs(winding), 1);
                            EXPECT_TRUE(visited.insert({point, triangle}).second);
                            result[point] += winding;
                        });
    return result;
}

TEST(Winding, IsThatOfTheSolidAngle) {
    Random random(411);
    int within = 0;
    for (int round = 0; round < test::rounds_within_reason(60); ++round) {
        TriangleSoup solid = test::random_solid(random).transformed(test::random_turn(random));
        if (round % 3 == 0)
            solid = assemble({solid, inside_out(test::random_solid(random)), test::random_solid(random)});
        const IndexedMesh mesh = weld(solid);
        std::vector<Point3> points;
        for (int i = 0; i < 60; ++i)
            points.push_back({random.real(-4, 4), random.real(-4, 4), random.real(-4, 4)});
        const std::vector<int> found = windings(mesh, points, 1 + static_cast<unsigned>(round) % 3);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double expected = test::winding_by_solid_angle(mesh, points[i]);
            EXPECT_NEAR(found[i], expected, 1e-6) << round;
            within += found[i] != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(within, test::slowed ? 0 : 100);
}

TEST(Winding, CountsEdgesAndVerticesAboveAPointOnce) {
    // A grid of points below the corners and edges of two boxes, and below the diagonals of their faces.
    const IndexedMesh mesh =
        weld(assemble({moved(make_box(4, 4, 1), 0, 0, 3), moved(make_box(2, 2, 1), 1, 1, 6)}));
    const Box3 box = bounding_box(mesh);
    std::vector<Point3> points;
    for (const double z : {-1.0, 0.5, 2.0, 3.5, 5.0})
        for (double x = -0.5; x <= 4.5; x += 0.25)
            for (double y = -0.5; y <= 4.5; y += 0.25) {
                const auto in_side = [](double v) {
                    return v == 0 || v == 1 || v == 3 || v == 4;
                };
                if ((z == 0.5 || z == 3.5) && (in_side(x) || in_side(y)))
                    continue; // a point may be on a side
                points.push_back({box.min.x + x, box.min.y + y, box.min.z + z});
            }
    const std::vector<int> found = windings(mesh, points, 2);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(found[i], test::winding_by_solid_angle(mesh, points[i]), 1e-6)
            << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
}

TEST(Winding, OfNoPointsVisitsNothing) {
    EXPECT_TRUE(windings(weld(make_box(1, 1, 1)), {}, 1).empty());
    EXPECT_EQ(windings({}, {{0, 0, 0}}, 1), std::vector<int>{0});
}

} // namespace
} // namespace lamella::winding_cases
