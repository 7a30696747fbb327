#pragma once

// Visits all edges of a mesh, each with the triangles that use it: in parallel, in expected linear time.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

[[nodiscard]] inline bool degenerate(const std::array<std::uint32_t, 3>& t) noexcept {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// One side of one triangle, on the edge between the vertices `low` < `high`.
struct EdgeUse {
    std::uint32_t position; ///< index of `low` in its partition, and the two flags
    std::uint32_t high;
    std::uint32_t triangle;

    static constexpr std::uint32_t upwards_bit = 1U << 31;
    static constexpr std::uint32_t lowest_bit = 1U << 30;

    /// Returns true if the triangle runs from `low` to `high`.
    [[nodiscard]] bool upwards() const noexcept { return (position & upwards_bit) != 0; }
    /// Returns true if the ends of this side are the two lowest vertices of the triangle, which holds for
    /// exactly one of its sides.
    [[nodiscard]] bool lowest_side() const noexcept { return (position & lowest_bit) != 0; }
    [[nodiscard]] std::uint32_t low_in_partition() const noexcept { return position & (lowest_bit - 1); }
};

/// Returns the vertices of a side, the lower one first.
[[nodiscard]] inline std::pair<std::uint32_t, std::uint32_t> ends_of(const IndexedMesh& mesh,
                                                                     const EdgeUse& use) noexcept {
    const auto& t = mesh.triangles[use.triangle];
    const std::size_t at = t[0] == use.high ? 0 : t[1] == use.high ? 1 : 2;
    return {t[(at + (use.upwards() ? 2 : 1)) % 3], use.high};
}

/// Calls visit(uses, worker) once for each edge; `uses` is in no particular order. Triangles with a repeated
/// vertex have no edges.
///
///     scatter   sides go to the partition of their lower vertex; nearby vertices share one, so that a
///               mesh with locality is read and written almost in order
///     sort      within a partition by lower vertex (counting), then by upper vertex (few each)
template <class Visit>
void for_each_edge(Executor& executor, const IndexedMesh& mesh, const Visit& visit) {
    // 2^14 vertices have about 10^5 sides, which take about a megabyte, half of a second-level cache. There
    // are at most 2^12 partitions, so that an index fits into its 30 bits.
    const unsigned shift = std::max(14U, static_cast<unsigned>(std::bit_width(mesh.vertices.size() / 4096)));
    const std::size_t partitions = (mesh.vertices.size() >> shift) + 1;
    const std::size_t ranges = std::min<std::size_t>(executor.workers(), mesh.triangles.size() / 32768 + 1);
    const auto range_begin = [&](std::size_t r) {
        return mesh.triangles.size() * r / ranges;
    };

    const auto for_each_side = [&](std::size_t r, const auto& side) {
        for (std::size_t i = range_begin(r); i < range_begin(r + 1); ++i) {
            const auto& t = mesh.triangles[i];
            if (degenerate(t))
                continue;
            const std::uint32_t highest = std::max({t[0], t[1], t[2]});
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k];
                const std::uint32_t b = t[k == 2 ? 0 : k + 1];
                const std::uint32_t low = std::min(a, b);
                const std::uint32_t high = std::max(a, b);
                const std::uint32_t flags =
                    (a < b ? EdgeUse::upwards_bit : 0) | (high != highest ? EdgeUse::lowest_bit : 0);
                side(low >> shift,
                     EdgeUse{(low & ((1U << shift) - 1)) | flags, high, static_cast<std::uint32_t>(i)});
            }
        }
    };

    // Count, prefix sum, fill.
    std::vector<std::vector<std::size_t>> next(ranges, std::vector<std::size_t>(partitions, 0));
    executor.for_chunks(ranges, 1, [&](std::size_t r, std::size_t, unsigned) {
        for_each_side(r, [&](std::size_t partition, const EdgeUse&) { ++next[r][partition]; });
    });
    std::vector<std::size_t> begin(partitions + 1, 0);
    std::size_t sum = 0;
    for (std::size_t p = 0; p < partitions; ++p) {
        begin[p] = sum;
        for (std::vector<std::size_t>& counts : next) {
            const std::size_t count = counts[p];
            counts[p] = sum;
            sum += count;
        }
    }
    begin[partitions] = sum;
    assert(sum <= 3 * mesh.triangles.size());
    const PageArray<EdgeUse> scattered(sum);
    executor.for_chunks(ranges, 1, [&](std::size_t r, std::size_t, unsigned) {
        for_each_side(
            r, [&](std::size_t partition, const EdgeUse& use) { scattered[next[r][partition]++] = use; });
    });
    assert(std::equal(next.back().begin(), next.back().end(), begin.begin() + 1)); // each partition is full

    struct Workspace {
        std::vector<std::size_t> begin;
        std::vector<EdgeUse> sorted;
    };
    std::vector<Workspace> workspaces(executor.workers());
    executor.for_chunks(partitions, 1, [&](std::size_t p, std::size_t, unsigned worker) {
        const std::span<const EdgeUse> uses = scattered.span().subspan(begin[p], begin[p + 1] - begin[p]);
        Workspace& work = workspaces[worker];
        work.begin.assign((std::size_t{1} << shift) + 1, 0);
        for (const EdgeUse& use : uses)
            ++work.begin[use.low_in_partition() + 1];
        for (std::size_t v = 1; v < work.begin.size(); ++v)
            work.begin[v] += work.begin[v - 1];
        assert(work.begin.back() == uses.size());
        work.sorted.resize(uses.size());
        for (const EdgeUse& use : uses)
            // Afterwards begin[v] is the end of the sides of v.
            work.sorted[work.begin[use.low_in_partition()]++] = use;
        std::size_t from = 0;
        for (std::size_t v = 0; v + 1 < work.begin.size(); ++v) {
            const std::size_t to = work.begin[v];
            std::sort(work.sorted.begin() + static_cast<std::ptrdiff_t>(from),
                      work.sorted.begin() + static_cast<std::ptrdiff_t>(to),
                      [](const EdgeUse& a, const EdgeUse& b) { return a.high < b.high; });
            while (from < to) {
                std::size_t end = from + 1;
                while (end < to && work.sorted[end].high == work.sorted[from].high)
                    ++end;
                visit(std::span<const EdgeUse>(work.sorted).subspan(from, end - from), worker);
                from = end;
            }
        }
    });
}

} // namespace lamella
