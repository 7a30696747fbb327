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
EdgeColumns lay_out_edges(const CutGraph<Ends>& graph, const Ranks& ranks,
                          std::span<const std::uint32_t> nodes, const PointKernels& kernels, double* to) {
    assert(!nodes.empty());
    const std::size_t stride = EdgeColumns::padded(nodes.size());
    double* const z0 = to;
    double* const far_z = z0 + stride;
    double* const x0 = far_z + stride;
    double* const far_x = x0 + stride;
    double* const y0 = far_x + stride;
    double* const far_y = y0 + stride;
    const bool low_is_base = ranks.rule() == PlaneRule::section_above;
    constexpr std::size_t ahead = 12;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i + ahead < nodes.size())
            __builtin_prefetch(&graph.nodes[nodes[i + ahead]].ends);
        const Ends& ends = graph.nodes[nodes[i]].ends;
        const Point3 base = low_is_base ? graph.low(ends) : graph.high(ends);
        const Point3 far = low_is_base ? graph.high(ends) : graph.low(ends);
        z0[i] = base.z;
        far_z[i] = far.z;
        x0[i] = base.x;
        far_x[i] = far.x;
        y0[i] = base.y;
        far_y[i] = far.y;
    }
    const EdgeColumns edges{to, nodes.size(), ranks.snap_mm()};
    kernels.prepare(edges);
    return edges;
}

} // namespace lamella
