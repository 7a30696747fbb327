#pragma once

// Who sweeps which planes.

#include "lamella/slicing/plan.hpp"

#include "slicing/sweep/plane_loads.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// Planes that one worker sweeps, or all of them together.
struct SweepTask {
    PlaneRange planes;
    std::uint32_t group; ///< planes that may be in flight together
    bool shared = false; ///< all workers share the work on each group

    friend bool operator==(const SweepTask&, const SweepTask&) = default;
};

/// Divides the planes among the workers: ascending tasks, none of them empty, that cover every plane once.
/// `points_in_flight` bounds the points of `workers` + 1 tasks, or of a group; 0: any number.
///
/// Tasks are of about equal work, as a rule. A task pays for walking once over all that is alive on its first
/// plane, so there are few of them where planes are few and large, and more where that cost is lost among the
/// planes, to level out what the estimate of the work misses.
///
/// There is one task, on which all workers share the work, where the bound on points in flight leaves no room
/// for a task of each worker; and where tasks would walk over as much as one worker that walks for all, as on
/// upright parts: what follows the walk is then shared evenly. But where the bound makes tasks of many planes
/// all the same, these are better: some workers slice while others deliver.
[[nodiscard]] std::vector<SweepTask> schedule(const PlaneLoads& loads, unsigned workers,
                                              std::uint64_t points_in_flight);

} // namespace lamella
