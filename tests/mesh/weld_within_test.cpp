#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/repair.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/meshes.hpp"
#include "fixtures/random.hpp"
#include "mesh/assemble.hpp"
#include "mesh/naive.hpp"
#include "mesh/repair_meshes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella::repair_cases {
namespace {

TEST(WeldWithin, ClosesTheCracksOfAJitteredSolid) {
    Random random(1);
    for (const TriangleSoup& soup : {make_sphere(10, 3), make_torus(10, 3, 40, 20), make_calibration()}) {
        const IndexedMesh torn = jittered(soup, 0.001, random);
        ASSERT_FALSE(inspect(torn).closed());
        const ToleranceWeld welded = weld_within(torn, 0.01, {.threads = 2});
        const Inspection found = inspect(welded.mesh);
        EXPECT_TRUE(found.closed());
        EXPECT_EQ(found.vertices, inspect(weld(soup)).vertices);
        EXPECT_EQ(welded.collapsed_triangles, 0U);
        EXPECT_EQ(welded.joined_vertices, torn.vertices.size() - found.vertices);
        EXPECT_GT(welded.longest_move_mm, 0);
        EXPECT_LE(welded.longest_move_mm, 0.01);
        EXPECT_EQ(welded.locations.size(), repair_locations);
        EXPECT_EQ(welded.pairs_apart, 0U);
        EXPECT_NEAR(found.volume_mm3, inspect(weld(soup)).volume_mm3, 0.002 * found.area_mm2);
    }
}

TEST(WeldWithin, DoesNotDependOnTheOrderOfVerticesAndThreads) {
    Random random(2);
    for (int round = 0; round < 30; ++round) {
        IndexedMesh mesh;
        for (int v = 0; v < 400; ++v)
            mesh.vertices.push_back(round % 2 == 0
                                        ? Point3{random.real(0, 1), random.real(0, 1), random.real(0, 1)}
                                        : Point3{static_cast<double>(random.integer(0, 9)) / 8,
                                                 static_cast<double>(random.integer(0, 9)) / 8,
                                                 static_cast<double>(random.integer(0, 9)) / 8});
        add_random_triangles(mesh, 300, random);
        const double tolerance = random.real(0.02, 0.3);
        const ToleranceWeld one = weld_within(mesh, tolerance, {.threads = 1});
        for (const unsigned threads : {1U, 2U, 7U}) {
            const ToleranceWeld other =
                weld_within(renumbered(mesh, random), tolerance, {.threads = threads});
            ASSERT_EQ(coordinates(other.mesh), coordinates(one.mesh));
            ASSERT_EQ(other.joined_vertices, one.joined_vertices);
            ASSERT_EQ(other.pairs_apart, one.pairs_apart);
            ASSERT_EQ(other.longest_move_mm, one.longest_move_mm);
            ASSERT_EQ(other.locations, one.locations);
        }
        EXPECT_LE(one.longest_move_mm, tolerance);
    }
}

TEST(WeldWithin, JoinsNoChains) {
    // Points 1 apart, 100 in a row: groups never get longer than the tolerance.
    IndexedMesh row;
    for (int i = 0; i < 100; ++i)
        row.vertices.push_back({static_cast<double>(i), 0, 0});
    for (std::uint32_t i = 0; i + 2 < 100; i += 3)
        row.triangles.push_back({i, i + 1, i + 2});
    const ToleranceWeld welded = weld_within(row, 1.5);
    EXPECT_EQ(welded.mesh.vertices.size(), 50U);
    EXPECT_EQ(welded.pairs_apart, 49U);
    EXPECT_EQ(welded.longest_move_mm, 1);
    EXPECT_EQ(welded.collapsed_triangles + welded.mesh.triangles.size(), 33U);
}

TEST(WeldWithin, TheClosestPairsAreJoinedFirst) {
    // The middle one is closer to the right one.
    const IndexedMesh three{{{0, 0, 0}, {1, 0, 0}, {1.75, 0, 0}}, {{0, 1, 2}}};
    const ToleranceWeld welded = weld_within(three, 1);
    ASSERT_EQ(welded.mesh.vertices.size(), 2U);
    EXPECT_EQ(welded.mesh.vertices[1], (Point3{1, 0, 0}));
    EXPECT_EQ(welded.collapsed_triangles, 1U);
    EXPECT_EQ(welded.pairs_apart, 1U);
}

TEST(WeldWithin, EqualVerticesAreOneAndDegenerateTrianglesStay) {
    const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}, {2, 3, 0}, {1, 1, 2}}};
    const ToleranceWeld welded = weld_within(mesh, 1e-6);
    EXPECT_EQ(welded.mesh.vertices.size(), 3U);
    EXPECT_EQ(welded.mesh.triangles.size(), 3U);
    EXPECT_EQ(welded.joined_vertices, 1U);
    EXPECT_EQ(welded.longest_move_mm, 0);
    EXPECT_TRUE(welded.locations.empty());
}

TEST(WeldWithin, RefusesTolerancesThatAreNone) {
    const IndexedMesh mesh = weld(make_sphere(1, 5));
    for (const double tolerance : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 10.0})
        test::expect_error(ErrorKind::usage, {"weld tolerance"}, [&] { (void)weld_within(mesh, tolerance); });
    EXPECT_EQ(weld_within({}, 1).mesh.vertices.size(), 0U);
}

/// The corners of `cubes` cubes apart, each corner three times within 2e-5.
IndexedMesh crumbs(int cubes) {
    IndexedMesh mesh;
    for (int c = 0; c < cubes; ++c)
        for (const double jolt : {0.0, 1e-5, 2e-5})
            for (const Triangle3& t : coordinates(weld(make_box(1, 1, 1)))) {
                const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
                for (const Point3& p : t)
                    mesh.vertices.push_back({p.x + jolt, p.y + 3.0 * (c % 30), p.z + 3.0 * (c / 30)});
                mesh.triangles.push_back({first, first + 1, first + 2});
            }
    return mesh;
}

TEST(WeldWithin, OneVertexFarAwayChangesNothing) {
    const IndexedMesh mesh = crumbs(900);
    const ToleranceWeld alone = weld_within(mesh, 1e-4);
    for (const double far : {1e6, -1e9, 1e30, 1e100}) {
        IndexedMesh stray = mesh;
        stray.vertices.push_back({far, far, far});
        const ToleranceWeld welded = weld_within(stray, 1e-4);
        EXPECT_EQ(welded.mesh.triangles, alone.mesh.triangles);
        EXPECT_EQ(welded.joined_vertices, alone.joined_vertices);
        EXPECT_EQ(welded.mesh.vertices.size(), alone.mesh.vertices.size() + 1);
    }
    EXPECT_EQ(alone.mesh.vertices.size(), 7200U);
}

/// Joined vertices and pairs left apart, by all pairs.
std::pair<std::uint64_t, std::uint64_t> naive_weld(std::vector<Point3> points, double tolerance) {
    const std::size_t vertices = points.size();
    const auto square = [](const Point3& a, const Point3& b) {
        return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
    };
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t b = 0; b < points.size(); ++b)
        for (std::size_t a = 0; a < b; ++a)
            if (square(points[a], points[b]) <= tolerance * tolerance)
                pairs.emplace_back(square(points[a], points[b]), a, b);
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::size_t> group(points.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    std::size_t groups = points.size();
    for (const auto& pair : pairs) {
        const std::size_t a = group[std::get<1>(pair)];
        const std::size_t b = group[std::get<2>(pair)];
        Box3 box;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (group[i] == a || group[i] == b)
                box.add(points[i]);
        if (a == b || square(box.max, box.min) > tolerance * tolerance)
            continue;
        std::replace(group.begin(), group.end(), b, a);
        --groups;
    }
    std::uint64_t apart = 0;
    for (const auto& pair : pairs)
        apart += group[std::get<1>(pair)] != group[std::get<2>(pair)] ? 1 : 0;
    return {vertices - groups, apart};
}

TEST(WeldWithin, FindsThePairsThatComparingAllFinds) {
    Random random(3);
    for (int round = 0; round < 400; ++round) {
        const double tolerance = round % 2 == 0 ? 0.125 : 0.1;
        const double unit = round % 4 < 2 ? tolerance : tolerance / 3; // many are just so far apart
        const double offset = round % 8 < 4 ? 0 : 1e9;
        IndexedMesh mesh;
        for (int v = 0; v < 60; ++v)
            mesh.vertices.push_back({offset + unit * static_cast<double>(random.integer(0, 9)),
                                     unit * static_cast<double>(random.integer(0, 9)),
                                     unit * static_cast<double>(random.integer(-9, 0))});
        const ToleranceWeld welded = weld_within(mesh, tolerance);
        EXPECT_EQ(std::pair(welded.joined_vertices, welded.pairs_apart),
                  naive_weld(mesh.vertices, tolerance));
    }
}

} // namespace
} // namespace lamella::repair_cases
