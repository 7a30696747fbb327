#pragma once

// Divides planes into tasks for the workers.

#include "lamella/slicing/plan.hpp"

#include "slicing/sweep/plane_loads.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// Planes that one worker sweeps, or all workers together.
struct SweepTask {
    PlaneRange planes;
    std::uint32_t group; ///< largest number of planes in flight together
    bool shared = false; ///< true if all workers share the work on these planes

    friend bool operator==(const SweepTask&, const SweepTask&) = default;
};

/// Divides the planes among the workers: returns ascending, non-empty tasks that cover every plane once.
/// `points_in_flight` bounds the points of `workers` + 1 tasks, or of the planes of a shared task that are in
/// flight together; 0: no bound.
///
/// Usually tasks are of about equal work. A task has an additional cost: at its first plane it must walk over
/// all nodes that are alive there. So there are few tasks if planes are few and large. If this cost is small,
/// there are more tasks, so that errors in the estimated work even out.
///
/// There is a single shared task in two cases. In the first, the bound on points in flight leaves no space
/// for a task of each worker. In the second, separate tasks would take as long for their walks as one worker
/// that walks alone, as on upright parts; with a shared task the work after the walk is divided evenly. If
/// the bound still permits tasks of many planes, separate tasks are preferred, because some workers slice
/// while others deliver.
[[nodiscard]] std::vector<SweepTask> schedule(const PlaneLoads& loads, unsigned workers,
                                              std::uint64_t points_in_flight);

} // namespace lamella
