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

/// The spans of all nodes, in classes by length: class c has those that 2^c to 2^(c + 1) - 1 planes cut. In a
/// class they are sorted by their first plane, so those that a plane may cut follow one another.
class PlaneIndex {
  public:
    /// O(nodes + planes).
    template <class Ends>
    PlaneIndex(const CutGraph<Ends>& graph, std::uint32_t planes) {
        std::vector<std::uint32_t> next(planes + std::size_t{1}); // the position of the next node that begins
        std::array<std::size_t, classes> sizes{};
        for (std::uint32_t node = 0; node < graph.count; ++node) {
            const PlaneSpan span = graph.spans[node];
            if (span.first == span.last)
                continue;
            assert(span.first < span.last && span.last <= planes);
            ++next[span.first + std::size_t{1}];
            ++sizes[class_of(span)];
        }
        for (std::uint32_t plane = 0; plane < planes; ++plane)
            next[plane + std::size_t{1}] += next[plane];
        PageArray<std::uint32_t> sorted(next.back());
        for (std::uint32_t node = 0; node < graph.count; ++node)
            if (const PlaneSpan span = graph.spans[node]; span.first != span.last)
                sorted[next[span.first]++] = node;
        for (std::size_t c = 0; c < classes; ++c)
            nodes_[c].reserve(sizes[c]);
        for (const std::uint32_t node : sorted.span()) {
            const PlaneSpan span = graph.spans[node];
            nodes_[class_of(span)].push_back({span, node});
        }
    }

    /// Replaces `found` by the nodes that the plane cuts.
    void find(std::uint32_t plane, std::vector<std::uint32_t>& found) const {
        found.clear();
        for (std::size_t c = 0; c < classes; ++c) {
            const std::uint64_t longest = (std::uint64_t{2} << c) - 1;
            auto entry = std::lower_bound(
                nodes_[c].begin(), nodes_[c].end(), plane,
                [&](const Entry& e, std::uint32_t p) { return e.span.first + longest <= p; });
            for (; entry != nodes_[c].end() && entry->span.first <= plane; ++entry)
                if (entry->span.last > plane)
                    found.push_back(entry->node);
        }
    }

  private:
    struct Entry {
        PlaneSpan span;
        std::uint32_t node;
    };
    static constexpr std::size_t classes = 31; // planes have numbers of 31 bits

    [[nodiscard]] static std::size_t class_of(PlaneSpan span) noexcept {
        return static_cast<std::size_t>(std::bit_width(span.last - span.first)) - 1;
    }

    std::array<std::vector<Entry>, classes> nodes_;
};

} // namespace lamella
