#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/even_planes.hpp"
#include "slicing/sweep/graph_of.hpp"
#include "slicing/sweep/walk.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::walk_cases {
namespace {

struct Found {
    std::vector<std::uint32_t> nodes;
    std::uint32_t valid_until;
    bool closed;
};

/// What the walk finds on a plane, from the nodes that begin there; nobody looks at it again where it serves.
std::vector<Found> walk_plane(Walk<SoupEnds>& walk, const CutGraph& graph, std::uint32_t plane) {
    std::vector<Found> found;
    walk.walk(plane, test::nodes_beginning_on(graph, plane), [&](const NodeSequence& sequence) {
        found.push_back(
            {{sequence.nodes.begin(), sequence.nodes.end()}, sequence.valid_until, sequence.closed});
    });
    for (const Found& one : found)
        walk.skip(one.nodes, one.valid_until);
    return found;
}

TEST(Walk, FindsTheContourOfAPrismOnceForAllItsPlanes) {
    const Ranks ranks(test::even_planes(0, 10, 20));
    const LocatedGraph<SoupEnds> graph = test::graph_of(make_box(20, 30, 10), ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    walk.begin_task({0, 20}, {});
    const std::vector<Found> found = walk_plane(walk, graph, 0);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(found[0].closed);
    EXPECT_EQ(found[0].nodes.size(), 8U); // four upright edges, four diagonals
    EXPECT_EQ(found[0].valid_until, 20U);
    for (std::uint32_t plane = 1; plane < 20; ++plane)
        EXPECT_TRUE(walk_plane(walk, graph, plane).empty());
}

TEST(Walk, WalksAContourAgainAfterSoManyPlanesThatWhatIsKeptOfItIsBounded) {
    const Ranks ranks(test::even_planes(0, 10, 1000));
    const LocatedGraph<SoupEnds> graph = test::graph_of(make_box(20, 30, 10), ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    walk.begin_task({0, 1000}, {});
    std::uint32_t served = 0;
    for (std::uint32_t plane = 0; plane < 1000; ++plane)
        for (const Found& one : walk_plane(walk, graph, plane)) {
            EXPECT_EQ(plane, served); // neither a plane left out nor one served twice
            EXPECT_TRUE(one.closed);
            EXPECT_LE(one.valid_until - plane, 64U);
            served = one.valid_until;
        }
    EXPECT_EQ(served, 1000U);
}

TEST(Walk, FollowsTheLinksOfThePlane) {
    const Ranks ranks(test::even_planes(-10, 10, 16));
    const LocatedGraph<SoupEnds> graph = test::graph_of(make_sphere(10, 3), ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    walk.begin_task({0, 16}, {});
    for (std::uint32_t plane = 0; plane < 16; ++plane) {
        for (const Found& one : walk_plane(walk, graph, plane)) {
            ASSERT_TRUE(one.closed);
            for (std::uint32_t p = plane; p < one.valid_until; ++p)
                for (std::size_t i = 0; i < one.nodes.size(); ++i)
                    EXPECT_EQ(graph.nodes[one.nodes[i]].next(p), one.nodes[(i + 1) % one.nodes.size()]);
        }
    }
}

TEST(Walk, JoinsWhatManyWalkersFoundOfOneContour) {
    const Ranks ranks(test::even_planes(0, 3, 3));
    const LocatedGraph<SoupEnds> graph =
        test::graph_of(shuffled(make_sheet({.holes = 1, .segments = 4000}), 7), ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    walk.begin_task({0, 3}, {});
    std::vector<std::uint32_t> visited;
    const std::vector<Found> found = walk_plane(walk, graph, 0);
    EXPECT_EQ(found.size(), 2U); // the outline and the hole
    for (const Found& one : found) {
        EXPECT_TRUE(one.closed);
        visited.insert(visited.end(), one.nodes.begin(), one.nodes.end());
    }
    EXPECT_EQ(test::sorted(visited), test::nodes_alive_on(graph, 0)); // each of them once
}

TEST(Walk, LooksAtTheNodesOfAChainAgainWhereItsSequenceEnds) {
    const Ranks ranks(test::even_planes(0, 3, 30));
    const LocatedGraph<SoupEnds> graph = test::graph_of(TriangleSoup(test::box_without_a_side()), ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    walk.begin_task({0, 30}, {});
    std::vector<bool> known(30, false);
    for (std::uint32_t plane = 0; plane < 30; ++plane) {
        for (const Found& one : walk_plane(walk, graph, plane)) {
            EXPECT_FALSE(one.closed);
            EXPECT_EQ(graph.nodes[one.nodes.back()].next(plane), no_node);
            for (std::uint32_t p = plane; p < one.valid_until; ++p) {
                EXPECT_FALSE(known[p]);
                known[p] = true;
            }
        }
        EXPECT_EQ(known[plane], !test::nodes_alive_on(graph, plane).empty());
    }
}

TEST(Walk, TakesUpInTheMiddleWhatReachesIntoATask) {
    const Ranks ranks(test::even_planes(0, 10, 20));
    const LocatedGraph<SoupEnds> graph = test::graph_of(make_box(20, 30, 10), ranks);
    const SharedMarks marks(graph.count, Fill::zero);
    Walk walk(graph, marks);
    const std::vector<std::uint32_t> carried = test::nodes_alive_on(graph, 7);
    walk.begin_task({7, 20}, carried);
    std::size_t contours = 0;
    walk.walk(7, {}, [&](const NodeSequence& sequence) {
        EXPECT_EQ(sequence.nodes.size(), 8U);
        ++contours;
    });
    EXPECT_EQ(contours, 1U);
}

} // namespace
} // namespace lamella::walk_cases
