#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/even_planes.hpp"
#include "slicing/sweep/graph_of.hpp"
#include "slicing/sweep/start_index.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::start_index_cases {
namespace {

std::vector<std::uint32_t> ascending(std::span<const std::uint32_t> nodes) {
    return test::sorted({nodes.begin(), nodes.end()});
}

TEST(StartIndex, NamesTheNodesThatBeginOnAPlaneAndThoseThatReachIntoATask) {
    const Ranks ranks(test::even_planes(-10, 10, 50));
    const LocatedGraph<SoupEnds> graph = test::graph_of(shuffled(make_sphere(10, 5), 3), ranks);
    const std::vector<SweepTask> tasks{{{0, 1}, 50}, {{1, 17}, 50}, {{17, 40}, 50}, {{40, 50}, 50}};
    for (const unsigned threads : {1U, 3U}) {
        Executor executor({.threads = threads});
        const std::vector<NodeRange> shares = count_nodes(graph, 50, executor);
        const PlaneLoads loads = loads_of(shares, 50);
        const StartIndex index(graph, shares, loads, tasks, executor);
        for (std::uint32_t plane = 0; plane < 50; ++plane)
            EXPECT_EQ(ascending(index.starts(plane)), test::nodes_beginning_on(graph, plane));
        for (std::size_t t = 0; t < tasks.size(); ++t) {
            std::vector<std::uint32_t> from_below;
            for (const std::uint32_t node : test::nodes_alive_on(graph, tasks[t].planes.begin))
                if (graph.nodes[node].first < tasks[t].planes.begin)
                    from_below.push_back(node);
            EXPECT_EQ(ascending(index.carried(t)), from_below);
        }
    }
}

TEST(PlaneLoads, CountTheNodesAliveOnEachPlane) {
    const Ranks ranks(test::even_planes(-10, 10, 50));
    const LocatedGraph<SoupEnds> graph = test::graph_of(make_sphere(10, 4), ranks);
    Executor executor({.threads = 2});
    const PlaneLoads loads = loads_of(count_nodes(graph, 50, executor), 50);
    std::uint64_t all = 0;
    std::uint64_t begun = 0;
    for (std::uint32_t plane = 0; plane < 50; ++plane) {
        EXPECT_EQ(loads.begun[plane], begun);
        EXPECT_EQ(loads.points[plane], test::nodes_alive_on(graph, plane).size());
        EXPECT_LE(loads.points[plane], loads.most_points);
        all += loads.points[plane];
        begun += test::nodes_beginning_on(graph, plane).size();
    }
    EXPECT_EQ(loads.all_points, all);
    EXPECT_EQ(loads.begun.back(), begun);
}

} // namespace
} // namespace lamella::start_index_cases
