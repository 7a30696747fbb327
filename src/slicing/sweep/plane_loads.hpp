#pragma once

// Numbers of nodes of the cut graph that are alive on each plane, and numbers of nodes that begin there.

#include "core/executor.hpp"
#include "slicing/sweep/cut_graph.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// A chunk of consecutive nodes for one worker, and the numbers of them that begin and end on each plane.
struct NodeRange {
    std::uint32_t begin;
    std::uint32_t end;
    std::vector<std::uint32_t> begins; ///< per plane, and one more entry
    std::vector<std::uint32_t> ends;   ///< likewise, on the plane after the last one that cuts the node
};

struct PlaneLoads {
    std::vector<std::uint64_t> points; ///< per plane: nodes alive on it, each of which is a point there
    std::vector<std::uint64_t> begun;  ///< per plane, and one more: nodes that begin before it
    std::uint64_t most_points = 0;     ///< largest number on one plane
    std::uint64_t all_points = 0;      ///< sum over all planes

    [[nodiscard]] std::uint32_t planes() const noexcept { return static_cast<std::uint32_t>(points.size()); }
};

/// Divides the nodes into chunks, at most one per worker and each large enough for a thread, and counts them.
inline std::vector<NodeRange> count_nodes(const CutGraph& graph, std::uint32_t planes, Executor& executor) {
    constexpr std::uint64_t worth_a_thread = 1U << 15; // nodes
    const std::uint64_t shares =
        std::clamp<std::uint64_t>(graph.count / worth_a_thread, 1, executor.workers());
    std::vector<NodeRange> result(shares);
    executor.for_chunks(shares, 1, [&](std::uint64_t s, std::uint64_t, unsigned) {
        NodeRange& share = result[s];
        share.begin = static_cast<std::uint32_t>(graph.count * s / shares);
        share.end = static_cast<std::uint32_t>(graph.count * (s + 1) / shares);
        share.begins.assign(planes + std::size_t{1}, 0);
        share.ends.assign(planes + std::size_t{1}, 0);
        for (std::uint32_t id = share.begin; id < share.end; ++id) {
            const CutNode& node = graph.nodes[id];
            assert(node.last <= planes);
            share.begins[node.first] += node.in_use();
            share.ends[node.last] += node.in_use();
        }
    });
    return result;
}

/// Returns the sums over all chunks.
inline PlaneLoads loads_of(const std::vector<NodeRange>& shares, std::uint32_t planes) {
    PlaneLoads loads;
    loads.points.resize(planes);
    loads.begun.resize(planes + std::size_t{1});
    std::uint64_t alive = 0;
    for (std::uint32_t p = 0; p < planes; ++p) {
        std::uint64_t begins = 0;
        for (const NodeRange& share : shares) {
            assert(share.begins.size() == planes + std::size_t{1} &&
                   share.ends.size() == share.begins.size());
            begins += share.begins[p];
            alive += share.begins[p];
            alive -= share.ends[p];
        }
        loads.points[p] = alive;
        loads.most_points = std::max(loads.most_points, alive);
        loads.all_points += alive;
        loads.begun[p + 1] = loads.begun[p] + begins;
    }
    assert(loads.begun.front() == 0);
    assert(planes == 0 || loads.points.front() == loads.begun[1]); // no node is alive before it begins
    return loads;
}

} // namespace lamella
