#pragma once

// Who works on which planes, and where contours begin on them.

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "slicing/cut_graph.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// What the planner knows about a plane: how many nodes are alive on it, and which begin there.
struct PlaneIndex {
    std::vector<std::uint64_t> points;  ///< per plane: the nodes alive on it
    std::uint64_t most_points = 0;      ///< on one plane
    std::uint64_t all_points = 0;       ///< on all planes
    PageArray<std::uint32_t> starts;    ///< nodes ordered by the plane they begin on
    std::vector<std::uint64_t> offsets; ///< starts of plane p are [offsets[p], offsets[p + 1])
    PageArray<std::uint32_t>
        carried; ///< what is alive on the first plane of a slab and began before, slab by slab
};

/// A stretch of planes that one worker sweeps; or all of them together, where single layers are so large that
/// only a few may be in flight.
struct Slab {
    std::uint32_t begin;
    std::uint32_t end;
    std::span<const std::uint32_t> carried; ///< the nodes alive on `begin` that began before
    std::uint32_t group;                    ///< planes that may be in flight together
    bool shared = false;                    ///< all workers share the work on each group
};

/// A worker's fixed share of the nodes, and how many of them begin and end on each plane.
struct NodeShare {
    std::uint32_t begin;
    std::uint32_t end;
    std::vector<std::uint32_t> begins;
    std::vector<std::uint32_t> ends;
};

template <class Ends>
std::vector<NodeShare> count_nodes(const CutGraph<Ends>& graph, std::uint32_t planes, Executor& executor) {
    constexpr std::uint64_t worth_a_thread = 1U << 15; // nodes
    const std::uint64_t shares =
        std::clamp<std::uint64_t>(graph.count / worth_a_thread, 1, executor.workers());
    std::vector<NodeShare> result(shares);
    executor.for_chunks(shares, 1, [&](std::uint64_t s, std::uint64_t, unsigned) {
        NodeShare& share = result[s];
        share.begin = static_cast<std::uint32_t>(graph.count * s / shares);
        share.end = static_cast<std::uint32_t>(graph.count * (s + 1) / shares);
        share.begins.assign(planes + std::size_t{1}, 0);
        share.ends.assign(planes + std::size_t{1}, 0);
        for (std::uint32_t id = share.begin; id < share.end; ++id) {
            const PlaneSpan span = graph.spans[id];
            const bool used = span.last != 0;
            share.begins[span.first] += used;
            share.ends[span.last] += used;
        }
    });
    return result;
}

/// How the planes are dealt out to the workers.
///
/// Into slabs of about equal work, as a rule. A slab pays for walking once over all that is alive on its
/// first plane, so there are few of them where planes are few and large, and more where that cost is lost
/// among the planes, to level out what the estimate of the work misses.
///
/// Into one slab, on which all workers share the work, where the bound on points in flight would make slabs
/// of a few planes only; and where all layers stay in memory and each slab would walk over as much as one
/// worker that walks for all, as on upright parts: what follows the walk is then shared evenly.
inline std::vector<Slab> deal_out(const PlaneIndex& index, unsigned workers, std::uint64_t points_in_flight) {
    constexpr std::uint64_t plane_cost = 64; // in points
    constexpr std::uint64_t worth_a_thread = 1U << 15;
    constexpr std::uint64_t worth_a_slab = 32; // planes
    const auto planes = static_cast<std::uint32_t>(index.points.size());
    std::uint64_t work = 0;
    for (const std::uint64_t p : index.points)
        work += p + plane_cost;
    if (work < workers * worth_a_thread)
        workers = 1;

    const std::uint64_t per_slab = points_in_flight / (workers + 1ULL); // one may wait for its turn
    const std::uint64_t largest_layer = std::max<std::uint64_t>(1, index.most_points);
    const auto one_for_all = [&](std::uint64_t group) {
        return std::vector<Slab>{
            {0, planes, {}, static_cast<std::uint32_t>(std::min<std::uint64_t>(group, planes)), workers > 1}};
    };
    if (points_in_flight != 0 && per_slab / largest_layer < std::min<std::uint64_t>(planes, worth_a_slab))
        return one_for_all(std::max<std::uint64_t>(1, points_in_flight / largest_layer));

    std::vector<Slab> slabs;
    const std::uint64_t wanted =
        workers == 1 ? 1 : workers * std::clamp<std::uint64_t>(planes / (workers * 32ULL), 1, 4);
    std::uint64_t target = work / wanted + 1;
    if (points_in_flight != 0)
        target = std::min(target, per_slab);
    std::uint64_t filled = 0;
    const std::uint64_t nodes = index.offsets.back();
    std::uint64_t walked = nodes;
    for (std::uint32_t p = 0; p < planes; ++p) {
        const std::uint64_t cost = index.points[p] + plane_cost;
        if (slabs.empty() || filled + cost / 2 > target) {
            slabs.push_back({p, p, {}, planes});
            filled = 0;
            walked += index.points[p] - (index.offsets[p + 1] - index.offsets[p]);
        }
        filled += cost;
        slabs.back().end = p + 1;
    }
    // Where layers are delivered on the way, slabs of their own let some slice while others deliver.
    if (points_in_flight == 0 && slabs.size() > 1 && workers * nodes <= walked + walked / 16)
        return one_for_all(planes);
    return slabs;
}

/// Sorts the nodes by the plane they begin on, and tells each slab which nodes reach into it from below.
template <class Ends>
PlaneIndex index_planes(const CutGraph<Ends>& graph, std::uint32_t planes, std::uint64_t points_in_flight,
                        Executor& executor, std::vector<Slab>& slabs) {
    std::vector<NodeShare> shares = count_nodes(graph, planes, executor);
    PlaneIndex index;
    index.points.assign(planes, 0);
    index.offsets.assign(planes + std::size_t{1}, 0);
    std::vector<std::vector<std::uint64_t>> fill(shares.size(), std::vector<std::uint64_t>(planes));
    std::uint64_t alive = 0;
    std::uint64_t begun = 0;
    for (std::uint32_t p = 0; p < planes; ++p) {
        for (std::size_t s = 0; s < shares.size(); ++s) {
            fill[s][p] = begun;
            begun += shares[s].begins[p];
            alive += shares[s].begins[p];
            alive -= shares[s].ends[p];
        }
        index.points[p] = alive;
        index.most_points = std::max(index.most_points, alive);
        index.all_points += alive;
        index.offsets[p + 1] = begun;
    }

    slabs = deal_out(index, executor.workers(), points_in_flight);
    // The slab that a plane lies in; the last one where all slabs hold all planes.
    std::vector<std::uint32_t> slab_of(planes);
    for (std::uint32_t s = 0; s < slabs.size(); ++s)
        std::fill(slab_of.begin() + slabs[s].begin, slab_of.begin() + slabs[s].end, s);

    // What each share has for each slab, and then where it goes.
    std::vector<std::vector<std::uint64_t>> carry(shares.size(), std::vector<std::uint64_t>(slabs.size()));
    for (std::size_t s = 0; s < shares.size(); ++s) {
        std::uint64_t open = 0; // begun below the plane and not ended there
        for (std::uint32_t p = 0; p < planes; ++p) {
            open -= shares[s].ends[p];
            if (slabs[slab_of[p]].begin == p)
                carry[s][slab_of[p]] = open;
            open += shares[s].begins[p];
        }
    }
    std::vector<std::uint64_t> carried(slabs.size() + 1, 0);
    for (std::size_t b = 0; b < slabs.size(); ++b) {
        carried[b + 1] = carried[b];
        for (std::vector<std::uint64_t>& of_share : carry)
            carried[b + 1] += std::exchange(of_share[b], carried[b + 1]);
    }

    index.starts = PageArray<std::uint32_t>(begun);
    index.carried = PageArray<std::uint32_t>(carried.back());
    executor.for_chunks(shares.size(), 1, [&](std::uint64_t s, std::uint64_t, unsigned) {
        for (std::uint32_t id = shares[s].begin; id < shares[s].end; ++id) {
            const PlaneSpan span = graph.spans[id];
            if (span.last == 0)
                continue;
            index.starts[fill[s][span.first]++] = id;
            for (std::uint32_t b = slab_of[span.first] + 1; b < slabs.size() && slabs[b].begin < span.last;
                 ++b)
                index.carried[carry[s][b]++] = id;
        }
    });
    for (std::size_t b = 0; b < slabs.size(); ++b)
        slabs[b].carried = index.carried.span().subspan(carried[b], carried[b + 1] - carried[b]);
    return index;
}

} // namespace lamella
