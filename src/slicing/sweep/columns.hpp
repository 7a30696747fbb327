#pragma once

// The edges of a run, in the layout that the kernels need.

#include "core/pages.hpp"
#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/cut_points.hpp"
#include "slicing/sweep/point_kernels.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// Memory in which one worker computes.
struct Scratch {
    const PointKernels& kernels = point_kernels();
    CutPoints points;
    PageArray<double> columns; ///< of a run whose edges did not fit into the store

    /// Returns memory for the columns of `edges` edges; its previous content is lost.
    double* columns_for(std::size_t edges) {
        const std::size_t size = EdgeColumns::columns * EdgeColumns::padded(edges);
        if (columns.size() < size)
            columns = PageArray<double>(2 * size);
        return columns.data();
    }
};

/// Keeps the columns of runs until its capacity is exhausted.
class ColumnStore {
  public:
    static constexpr std::uint64_t not_kept = ~std::uint64_t{0};

    /// Allocates memory for `room` edges, a multiple of EdgeColumns::lanes.
    explicit ColumnStore(std::uint64_t room) : room_(room), columns_(EdgeColumns::columns * room) {
        assert(room % EdgeColumns::lanes == 0);
    }

    /// Reserves space for `edges` edges. Returns its offset, or not_kept if the store is full.
    std::uint64_t reserve(std::size_t edges) {
        const std::size_t stride = EdgeColumns::padded(edges);
        if (room_ - used_ < stride)
            return not_kept;
        const std::uint64_t position = used_;
        used_ += stride;
        return position;
    }

    [[nodiscard]] double* at(std::uint64_t position) const noexcept {
        assert(position < used_);
        return columns_.data() + EdgeColumns::columns * position;
    }

    /// Releases all reservations. Before anything else is reserved, columns that are still needed must be
    /// moved by move_down, in ascending order of their old offsets.
    void release() noexcept { used_ = 0; }
    std::uint64_t move_down(std::uint64_t position, std::size_t edges) {
        assert(position >= used_ && position + EdgeColumns::padded(edges) <= room_);
        const double* from = columns_.data() + EdgeColumns::columns * position;
        const std::uint64_t to = reserve(edges);
        std::copy(from, from + EdgeColumns::columns * EdgeColumns::padded(edges), at(to));
        return to;
    }

  private:
    std::uint64_t room_;
    std::uint64_t used_ = 0;
    PageArray<double> columns_;
};

/// Prepares the edges of a run for cutting. Writes their columns to `to`, which must have space for them.
template <class Ends>
EdgeColumns lay_out_edges(const LocatedGraph<Ends>& graph, const Ranks& ranks,
                          std::span<const std::uint32_t> nodes, const PointKernels& kernels, double* to) {
    assert(!nodes.empty());
    const std::size_t stride = EdgeColumns::padded(nodes.size());
    const bool low_is_base = ranks.rule() == PlaneRule::section_above;
    constexpr std::size_t ahead = 12;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i + 2 * ahead < nodes.size())
            __builtin_prefetch(&graph.nodes[nodes[i + 2 * ahead]]);
        if (i + ahead < nodes.size())
            graph.ends.prefetch(graph.nodes[nodes[i + ahead]].side);
        const auto [a, b] = graph.ends(graph.nodes[nodes[i]].side);
        const Point3 p = graph.ends.point(a);
        const Point3 q = graph.ends.point(b);
        // The columns z0, far_z, x0, far_x, y0, far_y. The order of the ends of a side is random, so a branch
        // would be mispredicted.
        const std::size_t q_is_base = static_cast<std::size_t>((p.z < q.z) != low_is_base);
        double* const of_p = to + i + q_is_base * stride;
        double* const of_q = to + i + (1 - q_is_base) * stride;
        of_p[0] = p.z;
        of_q[0] = q.z;
        of_p[2 * stride] = p.x;
        of_q[2 * stride] = q.x;
        of_p[4 * stride] = p.y;
        of_q[4 * stride] = q.y;
    }
    const EdgeColumns edges{to, nodes.size(), ranks.snap_mm()};
    kernels.prepare(edges);
    return edges;
}

} // namespace lamella
