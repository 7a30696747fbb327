#include "fixtures/random_solids.hpp"
#include "fixtures/rounds.hpp"
#include "mesh/assemble.hpp"
#include "mesh/naive.hpp"
#include "mesh/shells.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::shells_cases {
namespace {

using test::Random;

struct Found {
    explicit Found(IndexedMesh of, unsigned threads = 1)
        : mesh(std::move(of)), execution{.threads = threads}, executor(execution),
          shells(find_shells(executor, mesh, survey_edges(executor, mesh, false))) {}

    IndexedMesh mesh;
    Execution execution;
    Executor executor;
    Shells shells;
};

IndexedMesh of_triangles(std::vector<Triangle3f> triangles) {
    return weld(TriangleSoup(std::move(triangles)));
}

TEST(Shells, AreNumberedByTheirFirstTriangles) {
    Random random(421);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        IndexedMesh mesh;
        mesh.vertices.resize(static_cast<std::size_t>(random.integer(3, 40)));
        add_random_triangles(mesh, random.integer(0, 40), random);
        const Found found(mesh, 1 + static_cast<unsigned>(round) % 3);
        const Shells& shells = found.shells;
        ASSERT_EQ(shells.closed.size(), shells.size());
        EXPECT_EQ(shells.size(), naive_shells(mesh)) << round;
        std::uint32_t next = 0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const std::uint32_t shell = shells.of_triangle[i];
            ASSERT_EQ(shell == no_shell, naive_degenerate(mesh.triangles[i])) << round;
            if (shell == no_shell)
                continue;
            ASSERT_LE(shell, next) << round;
            if (shell == next) {
                EXPECT_EQ(shells.first[next++], i) << round;
            }
        }
        EXPECT_EQ(next, shells.size()) << round;
    }
}

TEST(Shells, HaveTheVolumesAndBoxesOfTheirSolids) {
    Random random(422);
    for (int round = 0; round < test::rounds_within_reason(60); ++round) {
        std::vector<Triangle3f> triangles;
        std::vector<TriangleSoup> solids;
        for (std::int64_t n = random.integer(1, 6); n > 0; --n) {
            TriangleSoup solid =
                moved(test::random_solid(random).transformed(test::random_turn(random)),
                      1000.0 * static_cast<double>(n), random.real(-5, 5), random.real(-5, 5));
            if (random.integer(0, 1) == 0)
                solid = inside_out(solid);
            solids.push_back(TriangleSoup(triangles_of(solid)));
            const std::vector<Triangle3f> more = triangles_of(solid);
            triangles.insert(triangles.end(), more.begin(), more.end());
        }
        Found found(of_triangles(triangles), 1 + static_cast<unsigned>(round) % 3);
        ASSERT_EQ(found.shells.size(), solids.size()) << round;
        const std::vector<Box3> boxes = shell_boxes(found.mesh, found.shells);
        std::vector<Point3> origins;
        for (const Box3& box : boxes)
            origins.push_back(box.min);
        const std::vector<ShellContent> contents =
            shell_contents(found.executor, found.mesh, found.shells, origins);
        for (std::size_t s = 0; s < solids.size(); ++s) {
            const Box3 box = bounding_box(solids[s]);
            EXPECT_EQ(boxes[s].min, box.min);
            EXPECT_EQ(boxes[s].max, box.max);
            EXPECT_TRUE(found.shells.closed[s]);
            EXPECT_TRUE(contents[s].certain());
            EXPECT_NEAR(contents[s].volume(), volume(solids[s]), 1e-6 * std::abs(volume(solids[s]))) << round;
            EXPECT_EQ(contents[s].triangles, static_cast<double>(solids[s].size()));
        }
    }
}

TEST(Shells, WithAHoleAreNotClosed) {
    std::vector<Triangle3f> triangles = triangles_of(make_box(1, 1, 1));
    triangles.pop_back();
    const std::vector<Triangle3f> whole = triangles_of(moved(make_box(1, 1, 1), 5, 0, 0));
    triangles.insert(triangles.end(), whole.begin(), whole.end());
    const Found found(of_triangles(triangles));
    EXPECT_EQ(found.shells.closed, (std::vector<bool>{false, true}));
}

TEST(Shells, WithoutVolumeHaveNoCertainSign) {
    // A flat sheet, tilted, with both of its sides.
    const auto corner = [](float x, float y) {
        return Point3f{x, y, 0.1F * x + 0.3F * y};
    };
    const Triangle3f up{corner(0.1F, 0.2F), corner(1.7F, 0.3F), corner(0.4F, 1.9F)};
    const Found sheet(of_triangles({up, {up[0], up[2], up[1]}}));
    Executor executor(sheet.execution);
    const std::vector<Point3> origins{{0, 0, 0}};
    EXPECT_FALSE(shell_contents(executor, sheet.mesh, sheet.shells, origins)[0].certain());
}

TEST(Shells, EncloseTheSpheresWithinThem) {
    Random random(423);
    std::size_t enclosures = 0;
    for (int round = 0; round < 60; ++round) {
        struct Sphere {
            Point3 centre;
            double radius;
            bool outward;
        };
        std::vector<Sphere> spheres;
        std::vector<Triangle3f> triangles;
        while (spheres.size() < 6) {
            const Sphere next{{random.real(-5, 5), random.real(-5, 5), random.real(-5, 5)},
                              random.real(0.2, 5),
                              random.integer(0, 1) == 0};
            // Their surfaces keep a distance, as the spheres are polyhedra.
            const bool free = std::all_of(spheres.begin(), spheres.end(), [&](const Sphere& other) {
                const double away = std::hypot(next.centre.x - other.centre.x, next.centre.y - other.centre.y,
                                               next.centre.z - other.centre.z);
                return away > next.radius + other.radius || away + 0.1 * std::max(next.radius, other.radius) <
                                                                std::abs(next.radius - other.radius);
            });
            if (!free)
                continue;
            spheres.push_back(next);
            TriangleSoup soup =
                moved(make_sphere(next.radius, 3), next.centre.x, next.centre.y, next.centre.z);
            if (!next.outward)
                soup = inside_out(soup);
            const std::vector<Triangle3f> more = triangles_of(soup);
            triangles.insert(triangles.end(), more.begin(), more.end());
        }
        Found found(of_triangles(triangles), 2);
        ASSERT_EQ(found.shells.size(), spheres.size()) << round;
        std::vector<bool> asked;
        for (std::size_t s = 0; s < spheres.size(); ++s)
            asked.push_back(random.integer(0, 3) != 0);
        std::vector<Enclosure> visited;
        for_each_enclosure(found.executor, found.mesh, found.shells, shell_boxes(found.mesh, found.shells),
                           asked, [&](const Enclosure& enclosure) { visited.push_back(enclosure); });
        std::vector<Enclosure> expected;
        for (std::uint32_t inner = 0; inner < spheres.size(); ++inner)
            for (std::uint32_t outer = 0; outer < spheres.size(); ++outer) {
                const Sphere& a = spheres[inner];
                const Sphere& b = spheres[outer];
                const double away =
                    std::hypot(a.centre.x - b.centre.x, a.centre.y - b.centre.y, a.centre.z - b.centre.z);
                if (inner != outer && asked[inner] && away + a.radius < b.radius)
                    expected.push_back({inner, outer, b.outward ? 1 : -1});
            }
        EXPECT_EQ(visited, expected) << round;
        enclosures += visited.size();
    }
    EXPECT_GT(enclosures, 10U);
}

} // namespace
} // namespace lamella::shells_cases
