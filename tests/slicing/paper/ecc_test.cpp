#include "fixtures/named_solids.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/naive_section.hpp"
#include "slicing/paper/paper_engines.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::counts_of;
using test::expect_same;
using test::slice_as_listed;
using test::slice_with;
using test::Triangles;

std::uint64_t intersections(const Triangles& triangles, const Plan& plan) {
    std::uint64_t n = 0;
    for (const PlannedLayer& layer : plan.layers)
        n += test::naive_section(triangles, layer.z, plan.rule).size();
    return n;
}

TEST(Ecc, SearchesOnceForEveryIntersection) {
    for (const test::Solid& solid : test::small_solids()) {
        SCOPED_TRACE(solid.name);
        const TriangleSoup mesh = solid.make();
        for (const test::NamedPlan& plan : test::plans_for(mesh, 12)) {
            const MatchingCounts counts = counts_of("ecc", mesh, plan.plan);
            EXPECT_EQ(counts.searches, intersections(test::triangles_of(mesh), plan.plan));
            EXPECT_EQ(counts.inserted.total(), counts.searches);
            EXPECT_EQ(counts.by_edge_link.total(), 0U);
            EXPECT_EQ(counts.inserted.new_list, counts.inserted.link + counts.inserted.close)
                << "every list was linked to another one or completed";
        }
    }
}

TEST(Ecc, TakesTheMemoryOfItsNodesAtLeast) {
    const TriangleSoup mesh = make_torus(6, 2, 24, 16);
    const MatchingCounts counts = counts_of("ecc", mesh, test::plans_for(mesh, 40)[2].plan);
    EXPECT_EQ(counts.node_bytes, 48U);
    EXPECT_GE(counts.bytes, counts.node_bytes * counts.inserted.total());
    EXPECT_LE(counts.bytes, 6 * counts.node_bytes * counts.inserted.total());
}

class ListEngine : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Each, ListEngine, testing::ValuesIn(test::list_engines()), test::engine_test_name);

TEST_P(ListEngine, KeepsChainsOfOpenMeshesAsTheSweepDoes) {
    test::Random random(30);
    for (int trial = 0; trial < test::rounds_within_reason(40); ++trial) {
        Triangles drum = test::rugged_drum(static_cast<std::size_t>(random.integer(3, 40)), random.bits());
        for (std::int64_t holes = random.integer(1, 8); holes > 0; --holes)
            drum.erase(drum.begin() + random.integer(0, static_cast<std::int64_t>(drum.size()) - 1));
        for (std::int64_t flips = random.integer(0, 2); flips > 0; --flips) {
            Triangle3f& t =
                drum[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(drum.size()) - 1))];
            std::swap(t[1], t[2]);
        }
        const TriangleSoup mesh = shuffled(test::soup(drum), random.bits());
        for (const test::NamedPlan& plan : test::plans_for(mesh, 25)) {
            SCOPED_TRACE(plan.name);
            expect_same(slice_with(GetParam(), mesh, plan.plan), slice(mesh, plan.plan));
        }
    }
}

TEST_P(ListEngine, ReadsTheSectionsOfAnyTriangles) {
    // Edges with any number of triangles: which piece goes on where depends on the order, but nothing is
    // lost, nothing is added, and there are never more open ends than there must be.
    for (int seed = 0; seed < test::rounds_within_reason(300); ++seed) {
        SCOPED_TRACE(seed);
        const auto count = static_cast<std::size_t>(1 + seed % 70);
        const Triangles triangles = test::random_triangles(count, 1 + seed % 4, seed);
        for (const SliceAt at : {SliceAt::bottom, SliceAt::top}) {
            const Plan plan = plan_listed({-1, 0, 0.25, 0.5, 1, 1.5, 2, 2.25, 3, 3.5, 4}, at);
            test::expect_sections(slice_with(GetParam(), test::soup(triangles), plan), triangles, plan);
        }
    }
}

TEST_P(ListEngine, LeavesNoMoreOpenEndsThanThereAre) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Triangles triangles =
            test::random_triangles(static_cast<std::size_t>(1 + seed % 70), 2, 1000 + seed);
        const Plan plan = plan_listed({0.375, 0.625, 1.375, 1.625});
        const LayerStack stack = slice_with(GetParam(), test::soup(triangles), plan);
        for (std::size_t i = 0; i < stack.size(); ++i) {
            const std::vector<test::CutSegment> section =
                test::naive_section(triangles, plan.layers[i].z, plan.rule);
            if (std::none_of(section.begin(), section.end(),
                             [](const test::CutSegment& s) { return s.from == s.to; })) {
                EXPECT_EQ(stack[i].open_chains(), test::open_ends(section)) << "seed " << seed;
            }
        }
    }
}

TEST_P(ListEngine, ClosesContoursOfBodiesThatShareEdges) {
    for (const Triangles& triangles :
         {test::boxes_sharing_an_upright_edge(), test::boxes_sharing_a_level_edge(),
          test::boxes_back_to_back(), test::boxes_stacked(), test::box_twice(), test::boxes_overlapping()}) {
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            const TriangleSoup mesh = shuffled(test::soup(triangles), seed);
            for (const test::NamedPlan& plan : test::plans_for(mesh, 9)) {
                const LayerStack stack = slice_with(GetParam(), mesh, plan.plan);
                test::expect_sections(stack, triangles, plan.plan);
                for (const Layer& layer : stack)
                    EXPECT_EQ(layer.open_chains(), 0U);
            }
        }
    }
}

TEST_P(ListEngine, MatchesByEdgesWherePointsCoincide) {
    // Two boxes that touch along a side, each with vertices of its own: nothing says that they are one.
    IndexedMesh mesh = test::indexed(test::box_triangles({0, 0, 0}, {2, 2, 3}));
    const IndexedMesh other = test::indexed(test::box_triangles({2, 0, 0}, {4, 2, 3}));
    for (std::size_t i = 0; i < other.triangles.size(); ++i) {
        std::array<std::uint32_t, 3> t = other.triangles[i];
        for (std::uint32_t& corner : t)
            corner += static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.triangles.insert(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(2 * i), t); // interleaved
    }
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    const Plan plan = plan_listed({0.5, 1, 2.5});
    const LayerStack apart = slice_as_listed(GetParam(), mesh, plan);
    expect_same(apart, slice_as_listed("sweep", mesh, plan));
    for (const Layer& layer : apart)
        EXPECT_EQ(layer.rings, 2U);
}

} // namespace
} // namespace lamella
