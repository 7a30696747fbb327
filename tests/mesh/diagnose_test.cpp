#include "lamella/core/error.hpp"
#include "lamella/mesh/diagnose.hpp"

#include "fixtures/random.hpp"
#include "mesh/assemble.hpp"
#include "mesh/naive.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace lamella {
namespace {

Diagnosis diagnosed(const TriangleSoup& soup, const DiagnosisOptions& options = {}) {
    return diagnose(weld(soup), options, {.threads = 2});
}

/// Without the triangles that `leaves_out` names.
template <class LeavesOut>
TriangleSoup without(const TriangleSoup& soup, const LeavesOut& leaves_out) {
    std::vector<Triangle3f> kept;
    for (const Triangle3f& t : triangles_of(soup))
        if (!leaves_out(t))
            kept.push_back(t);
    return TriangleSoup(std::move(kept));
}

TEST(Diagnose, ASoundSolidHasNothingToReportBesideItsShells) {
    const Diagnosis found = diagnosed(make_rook(), {.self_intersections = true});
    EXPECT_TRUE(found.counts.sound());
    EXPECT_EQ(found.boundary_loops + found.nonmanifold_vertices + found.opposite_pairs, 0U);
    EXPECT_TRUE(found.loops.empty() && found.nonmanifold_edges.empty() && found.conflicting_edges.empty() &&
                found.vertices.empty() && found.duplicate_triangles.empty());
    ASSERT_TRUE(found.self_intersections);
    EXPECT_EQ(found.self_intersections->pairs(), 0U);
    ASSERT_EQ(found.shells.size(), found.counts.shells);
    EXPECT_EQ(found.shells[0].kind, ShellKind::body);
    EXPECT_EQ(found.shells[0].triangles, 94080U);
    EXPECT_EQ(found.shells[0].box, found.counts.box);
    EXPECT_FALSE(found.shells[0].inside);
}

TEST(Diagnose, ABoxWithoutALidHasOneLoop) {
    const Diagnosis found = diagnosed(without(
        make_box(3, 4, 5), [](const Triangle3f& t) { return t[0].z == 5 && t[1].z == 5 && t[2].z == 5; }));
    ASSERT_EQ(found.boundary_loops, 1U);
    const BoundaryLoop& loop = found.loops[0];
    EXPECT_TRUE(loop.closed);
    EXPECT_EQ(loop.edges(), 4U);
    EXPECT_DOUBLE_EQ(loop.length_mm, 14);
    EXPECT_DOUBLE_EQ(found.boundary_length_mm, 14);
    EXPECT_EQ(loop.box, (Box3{{0, 0, 5}, {3, 4, 5}}));
    // The missing lid faces up: counter-clockwise seen from above.
    double area = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Point3& a = loop.points[i];
        const Point3& b = loop.points[(i + 1) % 4];
        area += a.x * b.y - b.x * a.y;
    }
    EXPECT_DOUBLE_EQ(area / 2, 12);
    EXPECT_EQ(found.shells[0].kind, ShellKind::open);
}

// More pairs of shells than are looked at together.
TEST(Diagnose, AVertexOnAnEdgeOfANeighbourMakesASlit) {
    IndexedMesh mesh = weld(make_box(10, 10, 10));
    // The first triangle is split at a point of one of its edges, whose other side stays whole.
    const std::array<std::uint32_t, 3> t = mesh.triangles.front();
    const auto [a, b, c] = corners(mesh, 0);
    mesh.vertices.push_back({a.x + (b.x - a.x) / 3, a.y + (b.y - a.y) / 3, a.z + (b.z - a.z) / 3});
    mesh.triangles.front() = {t[0], 8, t[2]};
    mesh.triangles.push_back({8, t[1], t[2]});
    const Diagnosis found = diagnose(mesh);
    EXPECT_EQ(found.counts.boundary_edges, 3U);
    EXPECT_EQ(found.boundary_loops, 1U);
    EXPECT_EQ(found.slits, 1U);
    EXPECT_LT(found.widest_slit_mm, 1e-14);
    // A hole is none, however narrow, where it is wider than rounding.
    mesh.vertices.back().x += 0.001;
    mesh.vertices.back().y += 0.001;
    mesh.vertices.back().z += 0.001;
    EXPECT_EQ(diagnose(mesh).boundary_loops, 1U);
    EXPECT_EQ(diagnose(mesh).slits, 0U);
    EXPECT_GT(diagnose(mesh).loops.front().width_mm, 1e-4);
}

TEST(Diagnose, ManyBoxesInOneAnotherHaveTheirDepths) {
    constexpr int n = 1500;
    std::vector<Triangle3f> triangles;
    for (int i = 0; i < n; ++i) {
        const double size = 2.0 * (n - i);
        for (const Triangle3f& t : triangles_of(moved(make_box(size, size, size), i, i, i)))
            triangles.push_back(t);
    }
    const Diagnosis found = diagnosed(TriangleSoup(std::move(triangles)), {.keep = n});
    ASSERT_EQ(found.shells.size(), static_cast<std::size_t>(n));
    for (std::uint32_t i = 0; i < n; ++i) {
        ASSERT_EQ(found.shells[i].depth, i);
        ASSERT_EQ(found.shells[i].inside, i == 0 ? std::nullopt : std::optional(i - 1));
    }
}

TEST(Diagnose, HolesThatTouchInAVertexHaveLoopsOfTheirOwn) {
    // Two triangles of a sphere that share a vertex and no edge.
    std::vector<Triangle3f> triangles = triangles_of(make_sphere(1, 2));
    const auto shared = [](const Triangle3f& a, const Triangle3f& b) {
        int n = 0;
        for (const Point3f& p : a)
            n += static_cast<int>(std::count(b.begin(), b.end(), p));
        return n;
    };
    for (std::size_t i = 1;; ++i)
        if (shared(triangles[0], triangles[i]) == 1) {
            triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(i));
            break;
        }
    triangles.erase(triangles.begin());
    const Diagnosis found = diagnosed(TriangleSoup(std::move(triangles)));
    ASSERT_EQ(found.boundary_loops, 2U);
    EXPECT_EQ(found.counts.boundary_edges, 6U);
    EXPECT_EQ(found.loops[0].edges(), 3U);
    EXPECT_EQ(found.loops[1].edges(), 3U);
    EXPECT_GE(found.loops[0].length_mm, found.loops[1].length_mm);
    EXPECT_EQ(found.nonmanifold_vertices, 1U);
}

TEST(Diagnose, ALoopBrokenByAFlippedTriangleIsReported) {
    std::vector<Triangle3f> triangles = triangles_of(make_box(1, 1, 1));
    triangles.erase(triangles.begin());
    // A neighbour of the hole.
    for (Triangle3f& t : triangles)
        if (t[0].z == 0 && t[1].z == 0 && t[2].z == 0)
            std::swap(t[0], t[1]);
    const Diagnosis found = diagnosed(TriangleSoup(triangles));
    EXPECT_EQ(found.counts.boundary_edges, 3U);
    EXPECT_GE(found.boundary_loops, 2U);
    std::size_t edges = 0;
    for (const BoundaryLoop& loop : found.loops) {
        EXPECT_FALSE(loop.closed);
        edges += loop.edges();
    }
    EXPECT_EQ(edges, 3U);
}

TEST(Diagnose, EveryBoundaryEdgeIsInOneLoopOnRandomMeshes) {
    test::Random random(31);
    for (int round = 0; round < 200; ++round) {
        const int vertices = 5 + round % 40;
        IndexedMesh mesh;
        for (int v = 0; v < vertices; ++v)
            mesh.vertices.push_back({random.real(0, 1), random.real(0, 1), static_cast<double>(v)});
        add_random_triangles(mesh, random.integer(0, 60), random);
        const Diagnosis found = diagnose(mesh, {.keep = DiagnosisOptions::keep_all});
        std::size_t edges = 0;
        double length = 0;
        for (const BoundaryLoop& loop : found.loops) {
            edges += loop.edges();
            length += loop.length_mm;
            std::vector<Point3> points = loop.points;
            std::sort(points.begin(), points.end());
            if (loop.closed) {
                EXPECT_TRUE(std::adjacent_find(points.begin(), points.end()) ==
                            points.end()); // no vertex twice
            }
        }
        EXPECT_EQ(edges, naive_edges(mesh).boundary);
        EXPECT_NEAR(length, found.boundary_length_mm, 1e-9 * (1 + length));
        EXPECT_EQ(found.loops.size(), found.boundary_loops);
        EXPECT_EQ(found.nonmanifold_edges.size(), naive_edges(mesh).nonmanifold);
        EXPECT_EQ(found.conflicting_edges.size(), naive_edges(mesh).unbalanced);
        EXPECT_EQ(found.duplicate_triangles.size(), naive_duplicates(mesh));
        EXPECT_EQ(found.degenerate_triangles.size(), naive_edges(mesh).degenerate_triangles);
        EXPECT_EQ(found.shells.size(), naive_shells(mesh));
        EXPECT_EQ(found.vertices.size(), found.nonmanifold_vertices);
        // The first few are the beginning of all.
        const Diagnosis few = diagnose(mesh, {.keep = 2});
        EXPECT_EQ(few.boundary_loops, found.boundary_loops);
        EXPECT_EQ(few.nonmanifold_vertices, found.nonmanifold_vertices);
        ASSERT_EQ(few.loops.size(), std::min<std::size_t>(2, found.loops.size()));
        for (std::size_t i = 0; i < few.loops.size(); ++i)
            EXPECT_EQ(few.loops[i].points, found.loops[i].points);
    }
}

TEST(Diagnose, CubesThatTouchAtACornerTouchInAVertexThoseAtAnEdgeDoNot) {
    const TriangleSoup cube = make_box(1, 1, 1);
    const Diagnosis corner = diagnosed(assemble({cube, moved(cube, 1, 1, 1)}));
    ASSERT_EQ(corner.nonmanifold_vertices, 1U);
    EXPECT_EQ(corner.vertices[0], (Point3{1, 1, 1}));
    const Diagnosis edge = diagnosed(assemble({cube, moved(cube, 1, 1, 0)}));
    EXPECT_EQ(edge.nonmanifold_vertices, 0U);
    ASSERT_EQ(edge.nonmanifold_edges.size(), 1U);
    for (const Point3& p : edge.nonmanifold_edges[0]) {
        EXPECT_EQ(p.x, 1);
        EXPECT_EQ(p.y, 1);
    }
}

TEST(Diagnose, OppositeTrianglesAreReportedFromRepeatedOnes) {
    const TriangleSoup cube = make_box(1, 1, 1);
    const Diagnosis twice = diagnosed(assemble({cube, cube}));
    EXPECT_EQ(twice.counts.duplicate_triangles, 12U);
    EXPECT_EQ(twice.opposite_pairs, 0U);
    const Diagnosis opposite = diagnosed(assemble({cube, inside_out(cube)}));
    EXPECT_EQ(opposite.counts.duplicate_triangles, 12U);
    EXPECT_EQ(opposite.opposite_pairs, 12U);
    EXPECT_EQ(diagnosed(assemble({cube, cube, inside_out(cube)})).opposite_pairs, 12U);
    std::vector<std::uint32_t> last(12);
    std::iota(last.begin(), last.end(), 12);
    EXPECT_EQ(opposite.duplicate_triangles, last);
}

TEST(Diagnose, ShellsKnowWhatTheyLieIn) {
    // A box with a hollow with a ball, the ball with a hollow; beside it a box that is inside out.
    const Diagnosis found = diagnosed(assemble({moved(make_sphere(2, 2), 5, 5, 5), make_box(10, 10, 10),
                                                moved(inside_out(make_box(8, 8, 8)), 1, 1, 1),
                                                moved(inside_out(make_sphere(1, 2)), 5, 5, 5),
                                                moved(inside_out(make_box(1, 1, 1)), 20, 0, 0)}));
    ASSERT_EQ(found.shells.size(), 5U);
    const auto expect = [&](std::size_t s, ShellKind kind, std::uint32_t depth, int inside) {
        EXPECT_EQ(found.shells[s].kind, kind) << s;
        EXPECT_EQ(found.shells[s].depth, depth) << s;
        EXPECT_EQ(found.shells[s].inside ? static_cast<int>(*found.shells[s].inside) : -1, inside) << s;
    };
    expect(0, ShellKind::body, 2, 2);
    expect(1, ShellKind::body, 0, -1);
    expect(2, ShellKind::cavity, 1, 1);
    expect(3, ShellKind::cavity, 3, 0);
    expect(4, ShellKind::inverted, 0, -1);
    EXPECT_NEAR(found.shells[1].volume_mm3, 1000, 1e-9);
    EXPECT_NEAR(found.shells[2].volume_mm3, -512, 1e-9);
    EXPECT_EQ(found.counts.cavities, 2U);
    EXPECT_EQ(found.counts.inverted_shells, 1U);
}

TEST(Diagnose, OverlapsBetweenShellsAreReportedByShells) {
    const Diagnosis found = diagnosed(
        assemble({make_box(4, 4, 4), moved(make_box(4, 2, 2), 2, 1, 1), moved(make_box(1, 1, 1), 20, 0, 0)}),
        {.self_intersections = true});
    ASSERT_TRUE(found.self_intersections);
    ASSERT_EQ(found.self_intersections->parts.size(), 1U);
    EXPECT_EQ(found.self_intersections->parts[0].part_a, 0U);
    EXPECT_EQ(found.self_intersections->parts[0].part_b, 1U);
    EXPECT_GT(found.self_intersections->parts[0].crossing, 0U);
}

TEST(Diagnose, CountsAsInspectDoesForAnyNumberOfThreads) {
    const IndexedMesh mesh = weld(assemble({make_rook(), moved(inside_out(make_sphere(2, 5)), 0, 0, 20),
                                            moved(make_torus(10, 2, 200, 90), 40, 0, 0)}));
    const Inspection expected = inspect(mesh, {.threads = 1});
    for (const unsigned threads : {1U, 2U, 7U}) {
        const Diagnosis found = diagnose(mesh, {}, {.threads = threads});
        EXPECT_EQ(found.counts.volume_mm3, expected.volume_mm3);
        EXPECT_EQ(found.counts.box, expected.box);
        EXPECT_EQ(found.counts.cavities, expected.cavities);
        EXPECT_EQ(found.counts.shells, expected.shells);
        EXPECT_EQ(found.shells.size(), std::min<std::size_t>(16, expected.shells));
    }
}

TEST(Diagnose, OfNothingReportsNothing) {
    const Diagnosis found = diagnose({});
    EXPECT_EQ(found.counts.triangles, 0U);
    EXPECT_TRUE(found.shells.empty());
}

} // namespace
} // namespace lamella
