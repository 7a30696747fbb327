#include "slicing/plane_ranges.hpp"
#include "slicing/sweep/cut_graph.hpp"

#include <algorithm>

namespace lamella {

std::uint64_t RangeMemory::bytes(const RangeNeeds& range) const noexcept {
    // While nodes are joined, each has a record of 8 bytes; 12 more are allowed because an edge whose
    // triangles different workers collect has two nodes until then. Later each node has an entry in the order
    // of starts and at most one in the lists of tasks that it reaches into. All workers share one mark per
    // node. The marks of its own that a worker has take at most as much.
    constexpr std::uint64_t joining = 8 + 12;
    const std::uint64_t walking = 8 + 4 * (std::uint64_t{threads} + 1);
    const std::uint64_t node = sizeof(CutNode) + std::max(joining, walking);
    // A point and the text that a sink makes of it.
    constexpr std::uint64_t point = sizeof(Point2) + 40;
    const std::uint64_t in_flight =
        std::min(std::max(points_in_flight, 2 * range.most_points), range.points + range.most_points);
    return sizeof(Triangle3f) * range.triangles + node * range.edges + point * in_flight;
}

} // namespace lamella
