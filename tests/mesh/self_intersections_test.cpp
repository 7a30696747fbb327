#include "lamella/mesh/self_intersections.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "mesh/assemble.hpp"
#include "mesh/triangle_contact.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace lamella {
namespace {

SelfIntersections found_in(const TriangleSoup& soup) {
    return find_self_intersections(weld(soup), {}, {.threads = 2});
}

/// Every pair, one by one.
SelfIntersections naive(const IndexedMesh& mesh) {
    SelfIntersections found;
    const auto named = [&](std::uint32_t i) {
        const auto& t = mesh.triangles[i];
        return NamedTriangle{{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, t};
    };
    const auto left_out = [&](std::uint32_t i) {
        return flat(named(i).corners);
    };
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
        found.flat_triangles += left_out(a) ? 1 : 0;
        for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
            if (left_out(a) || left_out(b))
                continue;
            const std::optional<IntersectionKind> c = contact(named(a), named(b));
            found.crossing += c == IntersectionKind::crossing ? 1 : 0;
            found.overlapping += c == IntersectionKind::overlapping ? 1 : 0;
            found.touching += c == IntersectionKind::touching ? 1 : 0;
        }
    }
    return found;
}

TEST(SelfIntersections, SoundSolidsHaveNone) {
    for (const TriangleSoup& soup : {make_rook(), make_dodecahedra(), make_calibration(), make_sphere(5, 5),
                                     make_torus(10, 2, 60, 30), make_lattice({.cells_x = 3, .cells_y = 3}),
                                     make_sheet({.holes = 25, .segments = 48, .size_mm = 20})}) {
        const SelfIntersections found = found_in(soup);
        EXPECT_EQ(found.pairs(), 0U);
        EXPECT_TRUE(found.first.empty());
        EXPECT_TRUE(found.parts.empty());
    }
}

TEST(SelfIntersections, RefusesPartsOfOtherTrianglesThanThereAre) {
    const IndexedMesh mesh = weld(make_box(4, 4, 4));
    for (const std::size_t count : {1U, 11U, 13U}) {
        const std::vector<std::uint32_t> parts(count, 0);
        test::expect_error(ErrorKind::usage, {"IntersectionOptions::parts", "12"},
                           [&] { static_cast<void>(find_self_intersections(mesh, {.parts = parts})); });
    }
}

TEST(SelfIntersections, BoxesThatOverlapCross) {
    // The smaller one sticks out of the right side of the larger one.
    const IndexedMesh mesh = weld(assemble({make_box(4, 4, 4), moved(make_box(4, 2, 2), 2, 1, 1)}));
    std::vector<std::uint32_t> parts(24, 0);
    std::fill(parts.begin() + 12, parts.end(), 1);
    const SelfIntersections found = find_self_intersections(mesh, {.keep = 100, .parts = parts});
    EXPECT_EQ(found.crossing, naive(mesh).crossing);
    EXPECT_GT(found.crossing, 0U);
    EXPECT_EQ(found.overlapping, 0U);
    ASSERT_EQ(found.parts.size(), 1U);
    EXPECT_EQ(found.parts[0].part_a, 0U);
    EXPECT_EQ(found.parts[0].part_b, 1U);
    EXPECT_EQ(found.parts[0].crossing, found.crossing);
    ASSERT_EQ(found.first.size(), found.pairs());
    for (const TriangleIntersection& intersection : found.first) {
        EXPECT_LT(intersection.triangle_a, 12U);
        EXPECT_GE(intersection.triangle_b, 12U);
        EXPECT_NEAR(intersection.at.x, 4, 1e-9); // on the side that it sticks out of
        EXPECT_GE(intersection.at.y, 1);
        EXPECT_LE(intersection.at.y, 3);
    }
}

TEST(SelfIntersections, BoxesBackToBackOverlapInTheirCommonSide) {
    // Sides of different size: other triangles, no common vertex.
    const SelfIntersections found =
        found_in(assemble({make_box(4, 4, 4), moved(make_box(4, 2, 2), 4, 1, 1)}));
    EXPECT_EQ(found.crossing, 0U);
    EXPECT_GE(found.overlapping, 2U);
    // The same side: two pairs with the same vertices.
    const SelfIntersections same = found_in(assemble({make_box(1, 1, 1), moved(make_box(1, 1, 1), 1, 0, 0)}));
    EXPECT_GE(same.overlapping, 2U);
    EXPECT_EQ(same.crossing, 0U);
}

TEST(SelfIntersections, SolidsThatShareAnEdgeOrACornerHaveNone) {
    EXPECT_EQ(found_in(assemble({make_box(1, 1, 1), moved(make_box(1, 1, 1), 1, 1, 0)})).pairs(), 0U);
    EXPECT_EQ(found_in(assemble({make_box(1, 1, 1), moved(make_box(1, 1, 1), 1, 1, 1)})).pairs(), 0U);
}

TEST(SelfIntersections, AVertexOnAnothersEdgeTouches) {
    const IndexedMesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 0, 0}, {2, -2, 1}, {4, -2, 0}},
                           {{0, 1, 2}, {3, 4, 5}}};
    const SelfIntersections found = find_self_intersections(mesh);
    EXPECT_EQ(found.touching, 1U);
    EXPECT_EQ(found.pairs(), 1U);
}

TEST(SelfIntersections, AgreeWithAllPairsOnRandomMeshesForAnyNumberOfThreads) {
    test::Random random(21);
    for (int round = 0; round < (test::slowed ? 12 : 60); ++round) {
        IndexedMesh mesh;
        const int vertices = 10 + round * 2;
        const bool grid = round % 2 == 0;
        for (int v = 0; v < vertices; ++v) {
            const auto coordinate = [&] {
                return grid ? static_cast<double>(random.integer(0, 6)) : random.real(-1, 1);
            };
            mesh.vertices.push_back({coordinate(), coordinate(), coordinate()});
        }
        add_random_triangles(mesh, 150, random);
        const SelfIntersections expected = naive(mesh);
        std::vector<std::uint32_t> parts(mesh.triangles.size());
        for (std::size_t i = 0; i < parts.size(); ++i)
            parts[i] = static_cast<std::uint32_t>(i % 3);
        std::vector<TriangleIntersection> first;
        for (const unsigned threads : {1U, 2U, 7U}) {
            const SelfIntersections found =
                find_self_intersections(mesh, {.keep = 5, .parts = parts}, {.threads = threads});
            ASSERT_EQ(found.crossing, expected.crossing);
            ASSERT_EQ(found.overlapping, expected.overlapping);
            ASSERT_EQ(found.touching, expected.touching);
            ASSERT_EQ(found.flat_triangles, expected.flat_triangles);
            std::uint64_t in_parts = 0;
            for (const PartIntersections& part : found.parts)
                in_parts += part.crossing + part.overlapping + part.touching;
            ASSERT_EQ(in_parts, found.pairs());
            if (threads == 1)
                first = found.first;
            ASSERT_EQ(found.first.size(), first.size());
            for (std::size_t i = 0; i < first.size(); ++i) {
                ASSERT_EQ(found.first[i].triangle_a, first[i].triangle_a);
                ASSERT_EQ(found.first[i].triangle_b, first[i].triangle_b);
                ASSERT_EQ(found.first[i].kind, first[i].kind);
            }
        }
    }
}

TEST(SelfIntersections, DoNotDependOnThePlacement) {
    // Exact maps: turns by 90 degrees, powers of two, far away and beyond single precision.
    const TriangleSoup soup =
        assemble({make_sphere(5, 3), moved(make_torus(5, 1, 24, 12), 0.25, 0, 0), make_box(3, 3, 8)});
    const SelfIntersections expected = found_in(soup);
    EXPECT_GT(expected.crossing, 100U);
    for (const Transform& map : {rotation('x', 90), rotation('z', 270), scaling(0x1p-300, 0x1p-300, 0x1p-300),
                                 scaling(0x1p300, 0x1p300, 0x1p300)}) {
        const SelfIntersections found = found_in(soup.transformed(map));
        EXPECT_EQ(found.crossing, expected.crossing);
        EXPECT_EQ(found.overlapping, expected.overlapping);
        EXPECT_EQ(found.touching, expected.touching);
    }
}

TEST(SelfIntersections, OfNothingAreNone) {
    EXPECT_EQ(find_self_intersections({}).pairs(), 0U);
    EXPECT_EQ(find_self_intersections({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}).flat_triangles, 1U);
}

TEST(SelfIntersections, StopWhenAsked) {
    CancelFlag stop;
    stop.request();
    const IndexedMesh mesh = weld(make_rook());
    for (const unsigned threads : {1U, 3U})
        test::expect_error(ErrorKind::cancelled, {}, [&] {
            (void)find_self_intersections(mesh, {}, {.threads = threads, .cancel = &stop});
        });
}

} // namespace
} // namespace lamella
