#pragma once

// The cut graph of a mesh, for tests of functions on it.

#include "lamella/mesh/triangle_soup.hpp"

#include "core/executor.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/cut_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lamella::test {

inline LocatedGraph<SoupEnds> graph_of(const TriangleSoup& soup, const Ranks& ranks) {
    const Execution execution{.threads = 1};
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::link, soup.size());
    return build_cut_graph(soup, ranks, executor, progress);
}

/// Returns the nodes in use that begin on the plane, ascending.
inline std::vector<std::uint32_t> nodes_beginning_on(const CutGraph& graph, std::uint32_t plane) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t id = 0; id < graph.count; ++id)
        if (graph.nodes[id].in_use() && graph.nodes[id].first == plane)
            nodes.push_back(id);
    return nodes;
}

/// Returns the nodes that the plane cuts, ascending.
inline std::vector<std::uint32_t> nodes_alive_on(const CutGraph& graph, std::uint32_t plane) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t id = 0; id < graph.count; ++id)
        if (graph.nodes[id].first <= plane && plane < graph.nodes[id].last)
            nodes.push_back(id);
    return nodes;
}

inline std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

} // namespace lamella::test
