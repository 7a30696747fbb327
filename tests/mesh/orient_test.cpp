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
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace lamella::repair_cases {
namespace {

/// With some of its triangles turned over.
IndexedMesh with_flipped(IndexedMesh mesh, double share, Random& random) {
    for (auto& t : mesh.triangles)
        if (random.real(0, 1) < share)
            std::swap(t[1], t[2]);
    return mesh;
}

TEST(Orient, LeavesSoundMeshesAsTheyAre) {
    for (const TriangleSoup& soup : {make_rook(), make_dodecahedra(), make_calibration()}) {
        const IndexedMesh mesh = weld(soup);
        const OrientedMesh oriented = orient(mesh, {.threads = 2});
        EXPECT_EQ(oriented.mesh.triangles, mesh.triangles);
        EXPECT_EQ(oriented.flipped_triangles + oriented.flipped_inward + oriented.flipped_outward, 0U);
        EXPECT_EQ(oriented.patches, inspect(mesh).shells);
    }
}

TEST(Orient, MendsFlippedTrianglesWhicheverAndHoweverMany) {
    Random random(3);
    for (const TriangleSoup& soup : {make_sphere(3, 3), make_torus(5, 2, 20, 12), make_dodecahedra(),
                                     assemble({make_box(4, 4, 4), moved(make_box(1, 1, 1), 9, 0, 0)})}) {
        const IndexedMesh sound = weld(soup);
        for (const double share : {0.05, 0.4, 0.8, 1.0}) {
            const IndexedMesh broken = with_flipped(sound, share, random);
            const OrientedMesh oriented = orient(broken);
            const Inspection found = inspect(oriented.mesh);
            EXPECT_TRUE(found.sound());
            EXPECT_NEAR(found.volume_mm3, inspect(sound).volume_mm3, 1e-9 * found.volume_mm3);
            std::uint64_t turned = 0;
            for (std::size_t i = 0; i < sound.triangles.size(); ++i)
                turned += oriented.mesh.triangles[i] != broken.triangles[i] ? 1 : 0;
            EXPECT_EQ(oriented.flipped_triangles, turned);
            EXPECT_EQ(oriented.non_orientable_patches, 0U);
        }
    }
}

TEST(Orient, TurnsVoidsInwardAndWhatLiesInThemOutward) {
    // All outward: a box, a hollow in it, a ball in the hollow.
    const IndexedMesh nested = weld(assemble(
        {moved(make_sphere(1, 2), 5, 5, 5), moved(make_box(8, 8, 8), 1, 1, 1), make_box(10, 10, 10)}));
    const OrientedMesh oriented = orient(nested);
    EXPECT_EQ(oriented.flipped_inward, 1U);
    EXPECT_EQ(oriented.flipped_outward, 0U);
    EXPECT_EQ(oriented.flipped_triangles, 12U);
    EXPECT_EQ(oriented.locations.size(), 12U);
    const Inspection found = inspect(oriented.mesh);
    EXPECT_EQ(found.cavities, 1U);
    EXPECT_EQ(found.inverted_shells, 0U);
    // Bodies that only partly lie in one another are no voids.
    const OrientedMesh crossing =
        orient(weld(assemble({make_box(10, 10, 2), moved(make_box(1, 1, 20), 5, 5, -1)})));
    EXPECT_EQ(crossing.flipped_triangles, 0U);
}

/// Boxes on a small grid, most of them larger than a cell: they share vertices, edges and sides, overlap, lie
/// in one another, and some are inside out.
TriangleSoup random_boxes(Random& random) {
    test::Triangles all;
    for (std::int64_t boxes = random.integer(1, 6); boxes > 0; --boxes) {
        const auto cell = [&](std::int64_t first, std::int64_t last) {
            return static_cast<float>(random.integer(first, last));
        };
        const Point3f low{cell(0, 2), cell(0, 2), cell(0, 2)};
        const Point3f high{low.x + cell(1, 2), low.y + cell(1, 2), low.z + cell(1, 2)};
        const test::Triangles box = test::box_triangles(low, high);
        const test::Triangles added = random.real(0, 1) < 0.3 ? test::flipped(box) : box;
        all.insert(all.end(), added.begin(), added.end());
    }
    return TriangleSoup(all);
}

TEST(Orient, MakesNoConflictsWhereThereAreNone) {
    Random random(5);
    std::vector<TriangleSoup> soups{
        TriangleSoup(test::boxes_sharing_an_upright_edge()),
        TriangleSoup(test::boxes_sharing_a_level_edge()),
        TriangleSoup(test::boxes_sharing_a_vertex()),
        TriangleSoup(test::boxes_back_to_back()),
        TriangleSoup(test::boxes_stacked()),
        TriangleSoup(test::box_twice()),
        TriangleSoup(test::boxes_overlapping()),
        TriangleSoup(test::box_with_a_cavity()),
        TriangleSoup(test::box_with_degenerate_triangles()),
        // A pocket that reaches the wall.
        TriangleSoup(test::joined({test::box_triangles({0, 0, 0}, {9, 9, 9}),
                                   test::flipped(test::box_triangles({5, 0, 0}, {9, 9, 9}))})),
    };
    for (const TriangleSoup& soup : soups)
        EXPECT_EQ(orient(weld(soup)).flipped_triangles, 0U);
    for (int round = 0; round < 500; ++round)
        soups.push_back(random_boxes(random));
    for (std::size_t i = 0; i < soups.size(); ++i) {
        SCOPED_TRACE(i);
        // Upright, and at an angle: where rounding tells volumes that are none.
        for (const Transform& place : {Transform{}, compose(rotation('x', 33), rotation('z', 10))}) {
            const IndexedMesh mesh = weld(soups[i].transformed(place));
            ASSERT_EQ(inspect(mesh).orientation_conflicts, 0U);
            const OrientedMesh oriented = orient(mesh);
            ASSERT_EQ(inspect(oriented.mesh).orientation_conflicts, 0U);
            ASSERT_EQ(orient(oriented.mesh).flipped_triangles, 0U);
        }
    }
}

TEST(Orient, MakesNoMoreConflictsThanThereAre) {
    Random random(6);
    int fewer = 0;
    for (int round = 0; round < 500; ++round) {
        const IndexedMesh sound = weld(random_boxes(random));
        const IndexedMesh broken = with_flipped(sound, 0.1, random);
        const std::uint64_t before = inspect(broken).orientation_conflicts;
        const std::uint64_t after = inspect(orient(broken).mesh).orientation_conflicts;
        ASSERT_LE(after, before);
        fewer += after < before ? 1 : 0;
    }
    EXPECT_GT(fewer, 400);
}

TEST(Orient, LeavesWhatIsTornAsItIs) {
    Random random(7);
    for (const TriangleSoup& soup : {make_sphere(10, 3), make_rook(), make_calibration()}) {
        const IndexedMesh torn = jittered(soup, 1e-4, random);
        EXPECT_EQ(orient(torn).flipped_triangles, 0U);
        EXPECT_EQ(orient(with_flipped(torn, 1, random)).flipped_triangles, 0U);
    }
    // A disc of many triangles at an angle has no volume, whatever the sum of its triangles says.
    const TriangleSoup drum =
        make_cylinder(3, 7, 37).transformed(compose(rotation('x', 31), rotation('y', 77)));
    IndexedMesh disc = weld(drum);
    const Point3 top = disc.vertices[disc.triangles[0][0]];
    const double size = std::hypot(top.x, top.y, top.z);
    for (IndexedMesh piece : {disc, with_flipped(disc, 1, random)}) {
        std::erase_if(piece.triangles, [&](const auto& t) {
            const Triangle3 c{piece.vertices[t[0]], piece.vertices[t[1]], piece.vertices[t[2]]};
            const Transform back = compose(rotation('y', -77), rotation('x', -31));
            return std::any_of(c.begin(), c.end(),
                               [&](const Point3& p) { return std::abs(back(p).z) > 1e-9 * size; });
        });
        ASSERT_GT(piece.triangles.size(), 30U);
        EXPECT_EQ(orient(piece).flipped_triangles, 0U);
    }
}

/// Triangles in another order, from another corner on.
IndexedMesh shuffled(const IndexedMesh& mesh, Random& random) {
    IndexedMesh out = mesh;
    for (std::size_t i = out.triangles.size(); i > 0; --i) {
        std::swap(out.triangles[i - 1],
                  out.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
        auto& t = out.triangles[i - 1];
        std::rotate(t.begin(), t.begin() + random.integer(0, 2), t.end());
    }
    return renumbered(out, random);
}

/// Triangles as coordinates, sorted, each from its smallest corner on; without degenerate ones.
std::vector<Triangle3> as_a_set(const IndexedMesh& mesh) {
    std::vector<Triangle3> all = coordinates(mesh);
    std::erase_if(all, [](const Triangle3& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    for (Triangle3& t : all)
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(all.begin(), all.end());
    return all;
}

/// Returns the soup with all corners at height 0.
TriangleSoup flattened(const TriangleSoup& soup) {
    std::vector<Triangle3f> triangles;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        Triangle3f& triangle = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3 p = soup.placed(i)[k];
            triangle[k] = {static_cast<float>(p.x), static_cast<float>(p.y), 0};
        }
    }
    return TriangleSoup(std::move(triangles));
}

TEST(Orient, DoesNotDependOnTheOrderOfTrianglesAndCorners) {
    Random random(8);
    for (int round = 0; round < 600; ++round) {
        SCOPED_TRACE(round);
        TriangleSoup soup = random_boxes(random);
        if (round % 3 == 0)
            soup = soup.transformed(compose(rotation('x', 33), rotation('z', 10)));
        if (round % 5 == 0) // flat, tied
            soup = flattened(soup);
        IndexedMesh mesh = with_flipped(weld(soup), random.real(0, 0.6), random);
        std::erase_if(mesh.triangles, [&](const auto&) { return random.real(0, 1) < 0.1; });
        for (std::int64_t again = random.integer(0, 3); again > 0 && !mesh.triangles.empty(); --again)
            mesh.triangles.push_back(mesh.triangles[static_cast<std::size_t>(
                random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))]);
        if (round % 4 == 0)
            add_random_triangles(mesh, 4, random);
        const OrientedMesh one = orient(mesh);
        for (int k = 0; k < 3; ++k) {
            const OrientedMesh other = orient(shuffled(mesh, random));
            ASSERT_EQ(as_a_set(other.mesh), as_a_set(one.mesh));
        }
    }
}

TEST(Orient, OfNeedlesNearlyTooThinToReportDoesNotDependOnTheOrderEither) {
    Random random(9);
    int turned = 0;
    int rounds = 0;
    for (double thickness = 1e-16; thickness < 1e-13; thickness *= 1.1, ++rounds) {
        SCOPED_TRACE(thickness);
        IndexedMesh needle;
        needle.vertices = {{0, 0, 0},
                           {1, 0, 0},
                           {random.real(-1, 1), random.real(-1, 1), 0},
                           {random.real(-0.3, 0.3), random.real(-0.3, 0.3), thickness}};
        needle.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}; // inside out or outward
        const OrientedMesh one = orient(needle, {.threads = 1});
        for (int corners = 0; corners < 81; ++corners) {
            IndexedMesh other = needle;
            for (int k = 0, rest = corners; k < 4; ++k, rest /= 3) {
                auto& t = other.triangles[static_cast<std::size_t>(k)];
                std::rotate(t.begin(), t.begin() + rest % 3, t.end());
            }
            std::rotate(other.triangles.begin(), other.triangles.begin() + corners % 4,
                        other.triangles.end());
            ASSERT_EQ(as_a_set(orient(other, {.threads = 1}).mesh), as_a_set(one.mesh));
        }
        turned += one.flipped_triangles != 0 ? 1 : 0;
    }
    EXPECT_GT(turned, 0);          // some have a volume,
    EXPECT_LT(turned, rounds / 2); // and others have none, or were outward
}

TEST(Orient, WhatLiesInABodyOnlyInPartIsNoVoid) {
    // An angle of 20 by 20 by 20, and a bar that pokes out of it into its notch: the box of the bar lies in
    // that of the angle, and the middle of its largest triangles in the material.
    const std::vector<Point3f> low{{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {10, 10, 0}, {10, 20, 0}, {0, 20, 0}};
    std::vector<Point3f> high = low;
    for (Point3f& p : high)
        p.z = 20;
    test::Triangles angle_triangles;
    for (std::size_t i = 0; i < low.size(); ++i) {
        const std::size_t k = (i + 1) % low.size();
        test::add_quad(angle_triangles, low[i], low[k], high[k], high[i]);
    }
    for (const std::array<std::size_t, 4>& c : {std::array<std::size_t, 4>{0, 1, 2, 3}, {0, 3, 4, 5}}) {
        test::add_quad(angle_triangles, high[c[0]], high[c[1]], high[c[2]], high[c[3]]);
        test::add_quad(angle_triangles, low[c[0]], low[c[3]], low[c[2]], low[c[1]]);
    }
    const TriangleSoup angle(angle_triangles);
    ASSERT_TRUE(inspect(weld(angle)).sound());
    const TriangleSoup bar(test::box_triangles({3, 3, 4}, {13, 18, 16}));
    for (const TriangleSoup& part : {bar, inside_out(bar)}) {
        const OrientedMesh oriented = orient(weld(assemble({angle, part})));
        EXPECT_EQ(oriented.flipped_inward, 0U);
        EXPECT_NEAR(inspect(oriented.mesh).volume_mm3, 6000 + 1800, 1e-6);
    }
}

TEST(Orient, WhatTouchesTheBodyAroundItStays) {
    const TriangleSoup box = make_box(10, 10, 10);
    const TriangleSoup part = moved(make_box(4, 4, 4), 0, 3, 3);
    for (const TriangleSoup& inner : {part, inside_out(part)}) {
        EXPECT_EQ(orient(weld(assemble({box, inner}))).flipped_triangles, 0U);
        EXPECT_EQ(orient(weld(assemble({inner, box}))).flipped_triangles, 0U);
    }
}

TEST(Orient, BodiesThatTouchInAnEdgeAreJudgedOneByOne) {
    const TriangleSoup box = make_box(1, 1, 1);
    const OrientedMesh oriented = orient(weld(assemble({inside_out(box), moved(inside_out(box), 1, 1, 0)})));
    EXPECT_EQ(oriented.patches, 2U);
    EXPECT_EQ(oriented.flipped_outward, 2U);
    EXPECT_NEAR(inspect(oriented.mesh).volume_mm3, 2, 1e-12);
}

TEST(Orient, AnOpenBodyIsTurnedOutwardWhereverItIs) {
    std::vector<Triangle3f> triangles = triangles_of(inside_out(make_box(3, 4, 5)));
    std::erase_if(triangles, [](const Triangle3f& t) { return t[0].z == 5 && t[1].z == 5 && t[2].z == 5; });
    for (const double x : {0.0, 100.0, -100.0}) {
        const OrientedMesh oriented =
            orient(weld(TriangleSoup(triangles).transformed(translation(x, x / 2, -x))));
        EXPECT_EQ(oriented.flipped_outward, 1U);
        EXPECT_EQ(oriented.flipped_triangles, 10U);
    }
}

TEST(Orient, AMoebiusStripStays) {
    Random random(9);
    IndexedMesh strip;
    const int n = 12;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * 3.14159265358979 * i / n;
        for (const double s : {-1.0, 1.0}) {
            const double r = 5 + s * std::cos(a / 2);
            strip.vertices.push_back({r * std::cos(a), r * std::sin(a), s * std::sin(a / 2)});
        }
    }
    const auto vertex = [&](int i, int side) {
        // After one round the sides are swapped.
        return static_cast<std::uint32_t>(i < n ? 2 * i + side : 2 * (i - n) + 1 - side);
    };
    for (int i = 0; i < n; ++i) {
        strip.triangles.push_back({vertex(i, 0), vertex(i + 1, 0), vertex(i + 1, 1)});
        strip.triangles.push_back({vertex(i, 0), vertex(i + 1, 1), vertex(i, 1)});
    }
    for (const IndexedMesh& mesh : {strip, with_flipped(strip, 0.3, random)}) {
        const OrientedMesh oriented = orient(mesh);
        EXPECT_EQ(oriented.non_orientable_patches, 1U);
        EXPECT_EQ(oriented.mesh.triangles, mesh.triangles);
    }
}

TEST(Orient, IsTheSameForAnyNumberOfThreadsOnRandomMeshes) {
    Random random(4);
    for (int round = 0; round < 100; ++round) {
        IndexedMesh mesh;
        const int vertices = 6 + round;
        for (int v = 0; v < vertices; ++v)
            mesh.vertices.push_back({random.real(0, 1), random.real(0, 1), random.real(0, 1)});
        add_random_triangles(mesh, 80, random);
        if (round % 10 == 0) { // edges are looked at by pieces of vertices: so there are several
            constexpr std::uint32_t pieces = 5;
            constexpr std::uint32_t piece = 1 << 14;
            std::vector<Point3> spread(std::size_t{pieces} * piece);
            const auto place = [](std::uint32_t v) {
                return v % pieces * piece + v / pieces;
            };
            for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
                spread[place(v)] = mesh.vertices[v];
            for (auto& triangle : mesh.triangles)
                for (std::uint32_t& v : triangle)
                    v = place(v);
            mesh.vertices = std::move(spread);
        }
        const OrientedMesh one = orient(mesh, {.threads = 1});
        const OrientedMesh many = orient(mesh, {.threads = 7});
        EXPECT_EQ(one.mesh.triangles, many.mesh.triangles);
        EXPECT_EQ(one.flipped_triangles, many.flipped_triangles);
        EXPECT_EQ(one.flipped_outward, many.flipped_outward);
        EXPECT_EQ(one.flipped_inward, many.flipped_inward);
        EXPECT_EQ(one.locations, many.locations);
        EXPECT_LE(one.flipped_outward + one.flipped_inward, one.patches);
        // Done once, there is nothing left to do.
        if (one.non_orientable_patches == 0) {
            EXPECT_EQ(orient(one.mesh).flipped_triangles, 0U);
        }
        const DroppedDuplicates dropped = drop_duplicates(mesh, {.threads = 7});
        EXPECT_EQ(dropped.mesh.triangles, drop_duplicates(mesh, {.threads = 1}).mesh.triangles);
        EXPECT_EQ(inspect(dropped.mesh).duplicate_triangles, 0U);
    }
}

} // namespace
} // namespace lamella::repair_cases
