#include "slicing/sweep/schedule.hpp"

#include <algorithm>
#include <cassert>

namespace lamella {

namespace {

constexpr std::uint64_t plane_cost = 64; // in points
constexpr std::uint64_t worth_a_thread = 1U << 15;
constexpr std::uint64_t worth_a_task = 32; // planes
// Points that stay in the cache of a core, 2 MB. If their layers are released before the next ones are made,
// these are written over them, and no fresh memory is needed.
constexpr std::uint64_t hot_points = std::uint64_t{1} << 17;
// Planes that are worth it to lay out the edges of long runs again.
constexpr std::uint64_t least_group = 4;

/// Returns one task that all workers share.
std::vector<SweepTask> one_for_all(std::uint32_t planes, unsigned workers, std::uint64_t group) {
    return {{{0, planes}, static_cast<std::uint32_t>(std::min<std::uint64_t>(group, planes)), workers > 1}};
}

[[maybe_unused]] bool covers_every_plane_once(const std::vector<SweepTask>& tasks, std::uint32_t planes) {
    std::uint32_t next = 0;
    for (const SweepTask& task : tasks) {
        if (task.planes.begin != next || task.planes.end <= next)
            return false;
        next = task.planes.end;
    }
    return next == planes;
}

} // namespace

std::vector<SweepTask> schedule(const PlaneLoads& loads, unsigned workers, std::uint64_t points_in_flight) {
    assert(workers > 0);
    assert(loads.begun.size() == loads.points.size() + 1);
    const std::uint32_t planes = loads.planes();
    if (planes == 0)
        return {};
    std::uint64_t work = 0;
    for (const std::uint64_t p : loads.points)
        work += p + plane_cost;
    if (work < workers * worth_a_thread)
        workers = 1;

    const bool bounded = points_in_flight != 0;
    const std::uint64_t per_task = points_in_flight / (workers + 1ULL); // besides those being swept, one task
                                                                        // may wait to be delivered
    const std::uint64_t largest_layer = std::max<std::uint64_t>(1, loads.most_points);
    const std::uint64_t planes_of_task = bounded ? per_task / largest_layer : planes;
    const auto group_of = [&](std::uint64_t hot, std::uint64_t most) {
        const std::uint64_t points = std::min(most, std::max(hot, least_group * largest_layer));
        return static_cast<std::uint32_t>(
            bounded ? std::clamp<std::uint64_t>(points / largest_layer, 1, planes) : planes);
    };
    const std::uint32_t group = group_of(workers * hot_points, points_in_flight);
    if (planes_of_task == 0)
        return one_for_all(planes, workers, group);
    const bool many_planes = planes_of_task >= std::min<std::uint64_t>(planes, worth_a_task);

    std::vector<SweepTask> tasks;
    const std::uint64_t wanted =
        workers == 1 ? 1 : workers * std::clamp<std::uint64_t>(planes / (workers * 32ULL), 1, 4);
    std::uint64_t target = work / wanted + 1;
    if (bounded)
        target = std::min(target, per_task);
    std::uint64_t filled = 0;
    const std::uint64_t nodes = loads.begun.back();
    std::uint64_t walked = nodes;
    for (std::uint32_t p = 0; p < planes; ++p) {
        const std::uint64_t cost = loads.points[p] + plane_cost;
        // In a task of many planes, exceeding the target by part of a plane matters little.
        if (tasks.empty() || filled + (many_planes ? cost / 2 : cost) > target) {
            tasks.push_back({{p, p}, group_of(hot_points, per_task)});
            filled = 0;
            walked += loads.points[p] - (loads.begun[p + 1] - loads.begun[p]);
        }
        filled += cost;
        tasks.back().planes.end = p + 1;
    }
    assert(covers_every_plane_once(tasks, planes));
    // If layers are delivered during slicing, with long tasks some workers slice while others deliver.
    if (tasks.size() <= 1 || (bounded && many_planes))
        return tasks;
    const std::uint64_t walking = std::min<std::uint64_t>(workers, tasks.size());
    const bool no_sooner = walking * nodes <= walked + walked / 16;
    // The nodes that reach into short tasks must not take more memory than one number per node.
    const bool too_many_carried = bounded && walked > 2 * nodes;
    if (no_sooner || too_many_carried)
        return one_for_all(planes, workers, group);
    return tasks;
}

} // namespace lamella
