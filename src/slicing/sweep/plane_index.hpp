#pragma once

// Finds the nodes of a cut graph that one plane cuts.

#include "core/pages.hpp"
#include "slicing/sweep/cut_graph.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

/// The planes of all nodes, in classes by length: class c has those that 2^c to 2^(c + 1) - 1 planes cut. In
/// a class they are sorted by their first plane, so those that a plane may cut follow one another.
class PlaneIndex {
  public:
    /// O(nodes + planes).
    PlaneIndex(const CutGraph& graph, std::uint32_t planes) {
        std::vector<std::uint32_t> next(planes + std::size_t{1}); // the position of the next node that begins
        std::array<std::size_t, classes> sizes{};
        for (const CutNode& node : graph.nodes.span().first(graph.count)) {
            if (!node.in_use())
                continue;
            assert(node.first < node.last && node.last <= planes);
            ++next[node.first + std::size_t{1}];
            ++sizes[class_of(node)];
        }
        for (std::uint32_t plane = 0; plane < planes; ++plane)
            next[plane + std::size_t{1}] += next[plane];
        PageArray<std::uint32_t> sorted(next.back());
        for (std::uint32_t node = 0; node < graph.count; ++node)
            if (graph.nodes[node].in_use())
                sorted[next[graph.nodes[node].first]++] = node;
        for (std::size_t c = 0; c < classes; ++c)
            nodes_[c].reserve(sizes[c]);
        for (const std::uint32_t id : sorted.span()) {
            const CutNode& node = graph.nodes[id];
            nodes_[class_of(node)].push_back({node.first, node.last, id});
        }
    }

    /// Replaces `found` by the nodes that the plane cuts.
    void find(std::uint32_t plane, std::vector<std::uint32_t>& found) const {
        found.clear();
        for (std::size_t c = 0; c < classes; ++c) {
            const std::uint64_t longest = (std::uint64_t{2} << c) - 1;
            auto entry =
                std::lower_bound(nodes_[c].begin(), nodes_[c].end(), plane,
                                 [&](const Entry& e, std::uint32_t p) { return e.first + longest <= p; });
            for (; entry != nodes_[c].end() && entry->first <= plane; ++entry)
                if (entry->last > plane)
                    found.push_back(entry->node);
        }
    }

  private:
    /// The planes [first, last) cut the node.
    struct Entry {
        std::uint32_t first;
        std::uint32_t last;
        std::uint32_t node;
    };
    static constexpr std::size_t classes = 31; // planes have numbers of 31 bits

    [[nodiscard]] static std::size_t class_of(const CutNode& node) noexcept {
        return static_cast<std::size_t>(std::bit_width(std::uint32_t{node.last} - node.first)) - 1;
    }

    std::array<std::vector<Entry>, classes> nodes_;
};

} // namespace lamella
