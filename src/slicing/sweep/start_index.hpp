#pragma once

// The nodes at which the walks of a plane start.

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/plane_loads.hpp"
#include "slicing/sweep/schedule.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// The nodes sorted by the plane on which they begin, and the nodes that reach into a task from below.
class StartIndex {
  public:
    /// Requires that the nodes were counted in `shares`, added up in `loads` and divided into `tasks`.
    StartIndex(const CutGraph& graph, const std::vector<NodeRange>& shares, const PlaneLoads& loads,
               const std::vector<SweepTask>& tasks, Executor& executor)
        : starts_before_(loads.begun), starts_(loads.begun.back()) {
        // Each plane's task.
        const std::uint32_t planes = loads.planes();
        std::vector<std::uint32_t> task_of(planes);
        for (std::uint32_t t = 0; t < tasks.size(); ++t)
            std::fill(task_of.begin() + tasks[t].planes.begin, task_of.begin() + tasks[t].planes.end, t);

        Positions positions = places_of(shares, loads, tasks, task_of);
        carried_ = PageArray<std::uint32_t>(carried_before_.back());
        executor.for_chunks(shares.size(), 1, [&](std::uint64_t s, std::uint64_t, unsigned) {
            for (std::uint32_t id = shares[s].begin; id < shares[s].end; ++id) {
                const CutNode& node = graph.nodes[id];
                if (!node.in_use())
                    continue;
                assert(node.first < node.last);
                starts_[positions.starts[s][node.first]++] = id;
                for (std::uint32_t t = task_of[node.first] + 1;
                     t < tasks.size() && tasks[t].planes.begin < node.last; ++t)
                    carried_[positions.carried[s][t]++] = id;
            }
        });
        // The last chunk has completed the starts of each plane and the nodes carried into each task.
        assert(std::equal(positions.starts.back().begin(), positions.starts.back().end(),
                          loads.begun.begin() + 1));
        assert(std::equal(positions.carried.back().begin(), positions.carried.back().end(),
                          carried_before_.begin() + 1));
    }

    /// Returns the nodes that begin on the plane.
    [[nodiscard]] std::span<const std::uint32_t> starts(std::uint32_t plane) const noexcept {
        assert(plane + std::size_t{1} < starts_before_.size());
        return starts_.span().subspan(starts_before_[plane],
                                      starts_before_[plane + 1] - starts_before_[plane]);
    }
    /// Returns the nodes that are alive on the first plane of a task and begin before it.
    [[nodiscard]] std::span<const std::uint32_t> carried(std::size_t task) const noexcept {
        assert(task + 1 < carried_before_.size());
        return carried_.span().subspan(carried_before_[task],
                                       carried_before_[task + 1] - carried_before_[task]);
    }

  private:
    /// The offset at which each chunk of the nodes writes next.
    struct Positions {
        std::vector<std::vector<std::uint64_t>> starts;  ///< per chunk and plane
        std::vector<std::vector<std::uint64_t>> carried; ///< per chunk and task
    };

    Positions places_of(const std::vector<NodeRange>& shares, const PlaneLoads& loads,
                        const std::vector<SweepTask>& tasks, const std::vector<std::uint32_t>& task_of) {
        const std::uint32_t planes = loads.planes();
        Positions positions;
        positions.starts.assign(shares.size(), std::vector<std::uint64_t>(planes));
        positions.carried.assign(shares.size(), std::vector<std::uint64_t>(tasks.size()));
        for (std::uint32_t p = 0; p < planes; ++p) {
            std::uint64_t position = loads.begun[p];
            for (std::size_t s = 0; s < shares.size(); ++s)
                positions.starts[s][p] = std::exchange(position, position + shares[s].begins[p]);
            assert(position == loads.begun[p + 1]);
        }
        // First the number of nodes that each chunk has for each task, then their offset.
        for (std::size_t s = 0; s < shares.size(); ++s) {
            std::uint64_t open = 0; // nodes that began below the plane and have not ended
            for (std::uint32_t p = 0; p < planes; ++p) {
                open -= shares[s].ends[p];
                if (tasks[task_of[p]].planes.begin == p)
                    positions.carried[s][task_of[p]] = open;
                open += shares[s].begins[p];
            }
        }
        carried_before_.assign(tasks.size() + 1, 0);
        for (std::size_t t = 0; t < tasks.size(); ++t) {
            std::uint64_t position = carried_before_[t];
            for (std::vector<std::uint64_t>& of_share : positions.carried)
                of_share[t] = std::exchange(position, position + of_share[t]);
            carried_before_[t + 1] = position;
        }
        return positions;
    }

    std::vector<std::uint64_t> starts_before_; ///< per plane, and one more entry
    PageArray<std::uint32_t> starts_;
    std::vector<std::uint64_t> carried_before_; ///< per task, and one more entry
    PageArray<std::uint32_t> carried_;
};

} // namespace lamella
