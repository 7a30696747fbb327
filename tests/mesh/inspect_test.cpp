#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"
#include "mesh/assemble.hpp"
#include "mesh/naive.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace lamella {
namespace {

Inspection inspected(const TriangleSoup& soup, unsigned threads = 2) {
    return inspect(weld(soup), {.threads = threads});
}

TriangleSoup cube() {
    return make_box(1, 1, 1);
}

TriangleSoup open_cube() {
    std::vector<Triangle3f> triangles = triangles_of(cube());
    triangles.pop_back();
    return TriangleSoup(std::move(triangles));
}

TriangleSoup cube_with_a_flipped_triangle() {
    std::vector<Triangle3f> triangles = triangles_of(cube());
    std::swap(triangles[4][0], triangles[4][1]);
    return TriangleSoup(std::move(triangles));
}

TriangleSoup three_triangles_on_an_edge() {
    return TriangleSoup(std::vector<Triangle3f>{{Point3f{0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
                                                {Point3f{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                                {Point3f{0, 0, 1}, {0, 0, 0}, {-1, -1, 0}}});
}

TriangleSoup cube_with_a_duplicate_triangle(bool turned) {
    std::vector<Triangle3f> triangles = triangles_of(cube());
    triangles.push_back({triangles[3][1], triangles[3][2], triangles[3][0]});
    if (turned)
        std::swap(triangles.back()[0], triangles.back()[1]);
    return TriangleSoup(std::move(triangles));
}

TriangleSoup cubes_touching_at_an_edge() {
    return assemble({cube(), moved(cube(), 1, 1, 0)});
}

TriangleSoup cubes_touching_at_a_corner() {
    return assemble({cube(), moved(cube(), 1, 1, 1)});
}

TriangleSoup box_with_a_cavity() {
    return assemble({make_box(10, 10, 10), moved(inside_out(cube()), 4, 4, 4)});
}

TriangleSoup cube_with_degenerate_triangles() {
    std::vector<Triangle3f> triangles = triangles_of(cube());
    triangles.push_back({Point3f{0, 0, 0}, {0, 0, 0}, {1, 0, 0}});
    triangles.push_back({Point3f{7, 7, 7}, {7, 7, 7}, {7, 7, 7}});
    return TriangleSoup(std::move(triangles));
}

TEST(Inspect, FindsNothingWrongWithSoundShapes) {
    for (const TriangleSoup& soup : {cube(), make_rook(), make_sphere(3, 4), make_torus(10, 3, 40, 20),
                                     make_sheet({.holes = 4, .segments = 16}),
                                     make_lattice({.cells_x = 2, .cells_y = 2, .cells_z = 2})}) {
        const Inspection found = inspected(soup);
        EXPECT_TRUE(found.closed());
        EXPECT_TRUE(found.sound());
        EXPECT_EQ(found.shells, 1U);
        EXPECT_EQ(found.cavities, 0U);
        EXPECT_EQ(found.triangles, soup.size());
        EXPECT_EQ(found.box, bounding_box(soup));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(found.volume_mm3), std::bit_cast<std::uint64_t>(volume(soup)));
    }
}

TEST(Inspect, MeasuresACube) {
    const Inspection found = inspected(make_box(1, 2, 3));
    EXPECT_EQ(found.volume_mm3, 6);
    EXPECT_EQ(found.area_mm2, 22);
    EXPECT_EQ(found.vertices, 8U);
    EXPECT_EQ(found.triangles, 12U);
}

TEST(Inspect, AnEmptyMeshHasNothing) {
    const Inspection found = inspect({});
    EXPECT_TRUE(found.box.empty());
    EXPECT_EQ(found.triangles + found.vertices + found.shells + found.boundary_edges, 0U);
    EXPECT_TRUE(found.sound());
}

TEST(Inspect, AnyKindOfDefectMakesAMeshUnsound) {
    for (const DefectKind& kind : defect_kinds) {
        Inspection found;
        EXPECT_TRUE(found.sound());
        found.*kind.count = 1;
        EXPECT_FALSE(found.sound()) << kind.words.key;
        EXPECT_EQ(words_of(kind.count).key, kind.words.key);
    }
}

TEST(Inspect, CountsTheEdgesOfAHole) {
    const Inspection found = inspected(open_cube());
    EXPECT_EQ(found.boundary_edges, 3U);
    EXPECT_EQ(found.orientation_conflicts, 0U);
    EXPECT_EQ(found.shells, 1U);
    EXPECT_FALSE(found.closed());
}

TEST(Inspect, CountsTheEdgesOfAFlippedTriangle) {
    const Inspection found = inspected(cube_with_a_flipped_triangle());
    EXPECT_EQ(found.boundary_edges, 0U);
    EXPECT_EQ(found.orientation_conflicts, 3U);
    EXPECT_EQ(found.nonmanifold_edges, 0U);
    EXPECT_FALSE(found.closed());
}

TEST(Inspect, CountsAnEdgeWithThreeTriangles) {
    const Inspection found = inspected(three_triangles_on_an_edge());
    EXPECT_EQ(found.nonmanifold_edges, 1U);
    EXPECT_EQ(found.orientation_conflicts, 1U);
    EXPECT_EQ(found.boundary_edges, 6U);
    EXPECT_EQ(found.shells, 1U);
}

TEST(Inspect, CountsDuplicateTrianglesWhicheverWayRound) {
    for (const bool turned : {false, true}) {
        const Inspection found = inspected(cube_with_a_duplicate_triangle(turned));
        EXPECT_EQ(found.duplicate_triangles, 1U);
        EXPECT_EQ(found.nonmanifold_edges, 3U);
        EXPECT_EQ(found.orientation_conflicts, 3U);
        EXPECT_FALSE(found.sound());
    }
    EXPECT_EQ(inspected(assemble({cube(), cube(), cube()})).duplicate_triangles, 24U);
    EXPECT_EQ(inspected(assemble({cube(), inside_out(cube())})).duplicate_triangles, 12U);
}

TEST(Inspect, CubesThatTouchAtAnEdgeAreClosedButNotManifold) {
    const Inspection found = inspected(cubes_touching_at_an_edge());
    EXPECT_TRUE(found.closed());
    EXPECT_EQ(found.nonmanifold_edges, 1U);
    EXPECT_EQ(found.shells, 1U);
    EXPECT_FALSE(found.sound());
}

TEST(Inspect, CubesThatTouchAtACornerAreTwoShells) {
    const Inspection found = inspected(cubes_touching_at_a_corner());
    EXPECT_TRUE(found.sound());
    EXPECT_EQ(found.shells, 2U);
    EXPECT_EQ(found.vertices, 15U);
}

TEST(Inspect, ACavityIsNotInverted) {
    const Inspection found = inspected(box_with_a_cavity());
    EXPECT_TRUE(found.sound());
    EXPECT_EQ(found.shells, 2U);
    EXPECT_EQ(found.cavities, 1U);
    EXPECT_EQ(found.inverted_shells, 0U);
    EXPECT_NEAR(found.volume_mm3, 999, 1e-9);
}

TEST(Inspect, ASphereInsideOutIsInverted) {
    const Inspection alone = inspected(inside_out(make_sphere(1, 3)));
    EXPECT_EQ(alone.inverted_shells, 1U);
    EXPECT_EQ(alone.cavities, 0U);
    EXPECT_TRUE(alone.closed());
    EXPECT_FALSE(alone.sound());
    const Inspection beside =
        inspected(assemble({make_box(1, 1, 1), moved(inside_out(make_sphere(1, 3)), 5, 0, 0)}));
    EXPECT_EQ(beside.inverted_shells, 1U);
    EXPECT_EQ(beside.cavities, 0U);
}

TEST(Inspect, InwardShellsAreJudgedByTheMaterialAroundThem) {
    // A solid in a cavity in a solid, and the same all inside out.
    const TriangleSoup nested =
        assemble({make_box(10, 10, 10), moved(inside_out(make_box(8, 8, 8)), 1, 1, 1),
                  moved(make_box(6, 6, 6), 2, 2, 2), moved(inside_out(make_box(4, 4, 4)), 3, 3, 3)});
    EXPECT_EQ(inspected(nested).cavities, 2U);
    EXPECT_EQ(inspected(nested).inverted_shells, 0U);
    EXPECT_EQ(inspected(inside_out(nested)).cavities, 0U);
    EXPECT_EQ(inspected(inside_out(nested)).inverted_shells, 2U);
    // A hollow within a hollow: no material there to be hollow in.
    const TriangleSoup twice = assemble({make_box(10, 10, 10), moved(inside_out(make_box(8, 8, 8)), 1, 1, 1),
                                         moved(inside_out(make_box(4, 4, 4)), 3, 3, 3)});
    EXPECT_EQ(inspected(twice).cavities, 1U);
    EXPECT_EQ(inspected(twice).inverted_shells, 1U);
}

TEST(Inspect, JudgesManyCavitiesOnAGridWithRaysThroughEdgesAndVertices) {
    // The middles of all cavities lie on lines through edges and vertices of the slabs above and below.
    std::vector<Triangle3f> triangles;
    const auto add = [&](const TriangleSoup& soup) {
        for (const Triangle3f& t : triangles_of(soup))
            triangles.push_back(t);
    };
    const int n = 12;
    add(make_box(n, n, 2));
    add(moved(make_sheet({.holes = 4, .segments = 8, .size_mm = n}), 0, 0, 4));
    std::uint64_t cavities = 0;
    std::uint64_t inverted = 0;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) {
            const TriangleSoup hollow = inside_out(make_sphere(0.25, 0));
            add(moved(hollow, x + 0.5, y + 0.5, 1));
            add(moved(hollow, x + 0.5, y + 0.5, 3)); // between the two parts
            ++cavities;
            ++inverted;
        }
    const Inspection found = inspected(TriangleSoup(std::move(triangles)));
    EXPECT_EQ(found.cavities, cavities);
    EXPECT_EQ(found.inverted_shells, inverted);
    EXPECT_EQ(found.shells, 2 + cavities + inverted);
}

TEST(Inspect, AShellFarAwayKeepsItsSign) {
    const TriangleSoup near = make_sphere(1, 4);
    const IndexedMesh sphere = weld(near);
    const double r = 1e-3;
    IndexedMesh far = transformed(sphere, compose(translation(1e6, 1e6, 1e6), scaling(r, r, r)));
    EXPECT_EQ(inspect(far).inverted_shells, 0U);
    for (auto& t : far.triangles)
        std::swap(t[0], t[1]);
    EXPECT_EQ(inspect(far).inverted_shells, 1U);
}

TEST(Inspect, AFlatSheetIsNotInsideOutHoweverItLies) {
    // Front and back are divided along different diagonals, so rounding gives them a volume.
    const IndexedMesh sheet{{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}},
                            {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    for (int angle = 1; angle < 360; ++angle) {
        const IndexedMesh turned = transformed(sheet, compose(rotation('x', angle), rotation('y', 11)));
        EXPECT_TRUE(inspect(turned).sound()) << angle;
        EXPECT_EQ(diagnose(turned).shells[0].kind, ShellKind::body) << angle;
    }
}

TEST(Inspect, DegenerateTrianglesAreCountedAndOtherwiseIgnored) {
    const Inspection found = inspected(cube_with_degenerate_triangles());
    EXPECT_EQ(found.degenerate_triangles, 2U);
    EXPECT_EQ(found.triangles, 14U);
    EXPECT_TRUE(found.closed());
    EXPECT_FALSE(found.sound());
    EXPECT_EQ(found.shells, 1U);
    EXPECT_EQ(found.duplicate_triangles, 0U);
    EXPECT_EQ(found.volume_mm3, 1);
}

TEST(Inspect, SharingIsTakenAtItsWord) {
    IndexedMesh mesh = weld(cube());
    mesh.vertices.push_back(mesh.vertices[mesh.triangles[0][0]]);
    mesh.triangles[0][0] = 8; // the same place, but not the same vertex
    EXPECT_EQ(inspect(mesh).boundary_edges, 4U);
    EXPECT_FALSE(inspect(mesh).closed());
}

TEST(Inspect, AgreesWithTheNaiveCountOnRandomMeshesForAnyNumberOfThreads) {
    std::mt19937 random(5);
    for (int round = 0; round < (test::slowed ? 20 : 60); ++round) {
        IndexedMesh mesh;
        const std::uint32_t vertices =
            4 + static_cast<std::uint32_t>(random() % (round % 3 == 0 ? 6 : 60'000));
        for (std::uint32_t v = 0; v < vertices; ++v)
            mesh.vertices.push_back({static_cast<double>(random() % 100), static_cast<double>(random() % 100),
                                     static_cast<double>(random() % 100)});
        const std::size_t triangles = random() % (round % 10 == 9 ? 80'000 : 300);
        for (std::size_t i = 0; i < triangles; ++i) {
            const auto v = static_cast<std::uint32_t>(random() % vertices);
            const std::uint32_t spread = round % 2 == 0 ? vertices : 5;
            const auto near = [&] {
                return static_cast<std::uint32_t>((v + random() % spread) % vertices);
            };
            mesh.triangles.push_back({v, near(), near()});
        }
        const EdgeCounts expected = naive_edges(mesh);
        for (const unsigned threads : {1U, 2U, 7U}) {
            const Inspection found = inspect(mesh, {.threads = threads});
            EXPECT_EQ(found.boundary_edges, expected.boundary);
            EXPECT_EQ(found.nonmanifold_edges, expected.nonmanifold);
            EXPECT_EQ(found.orientation_conflicts, expected.unbalanced);
            EXPECT_EQ(found.degenerate_triangles, expected.degenerate_triangles);
            EXPECT_EQ(found.duplicate_triangles, naive_duplicates(mesh));
            EXPECT_EQ(found.shells, naive_shells(mesh));
        }
    }
}

TEST(Inspect, IsTheSameForAnyNumberOfThreadsToTheLastBit) {
    const IndexedMesh mesh = weld(assemble({make_rook(), moved(inside_out(make_sphere(2, 5)), 0, 0, 20),
                                            moved(make_torus(10, 2, 200, 90), 40, 0, 0)}));
    const Inspection one = inspect(mesh, {.threads = 1});
    EXPECT_EQ(one.cavities, 1U);
    for (const unsigned threads : {2U, 7U}) {
        const Inspection many = inspect(mesh, {.threads = threads});
        EXPECT_EQ(std::bit_cast<std::uint64_t>(many.volume_mm3),
                  std::bit_cast<std::uint64_t>(one.volume_mm3));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(many.area_mm2), std::bit_cast<std::uint64_t>(one.area_mm2));
        EXPECT_EQ(many.shells, one.shells);
        EXPECT_EQ(many.cavities, one.cavities);
    }
}

TEST(Inspect, AnEdgeWithAHundredThousandTrianglesIsNoTrap) {
    std::vector<Triangle3f> triangles;
    for (int i = 0; i < 100'000; ++i)
        triangles.push_back({Point3f{0, 0, 0}, {0, 0, 1}, {1, static_cast<float>(i % 50'000), 0}});
    const Inspection found = inspected(TriangleSoup(std::move(triangles)));
    EXPECT_EQ(found.nonmanifold_edges, 1U);
    EXPECT_EQ(found.duplicate_triangles, 50'000U);
    EXPECT_EQ(found.shells, 1U);
}

TEST(Inspect, StopsWhenAsked) {
    CancelFlag stop;
    stop.request();
    const IndexedMesh mesh = weld(make_rook());
    for (const unsigned threads : {1U, 3U})
        test::expect_error(ErrorKind::cancelled, {},
                           [&] { (void)inspect(mesh, {.threads = threads, .cancel = &stop}); });
}

} // namespace
} // namespace lamella
