#include "mesh/edge_survey.hpp"

#include "mesh/edge_uses.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <iterator>
#include <span>
#include <utility>

namespace lamella {

namespace {

struct Worker {
    Inspection counts;
    std::uint64_t opposite_pairs = 0;
    EdgeLocations locations;
    std::vector<TriangleOverEdge> triangles;
};

/// Calls visit(group) for each group of two or more triangles with the same three vertices, in ascending
/// order. Considers the triangles whose two lowest vertices are the ends of the edge in `uses`. `work` is
/// scratch memory.
template <class Visit>
void for_each_same(const IndexedMesh& mesh, std::span<const EdgeUse> uses,
                   std::vector<TriangleOverEdge>& work, const Visit& visit) {
    work.clear();
    for (const EdgeUse& use : uses)
        if (use.lowest_side()) {
            const auto& t = mesh.triangles[use.triangle];
            work.push_back({std::max({t[0], t[1], t[2]}), use.triangle, use.upwards()});
        }
    if (work.size() < 2)
        return;
    std::sort(work.begin(), work.end());
    for (std::size_t begin = 0; begin < work.size();) {
        std::size_t end = begin + 1;
        while (end < work.size() && work[end].highest == work[begin].highest)
            ++end;
        if (end - begin > 1)
            visit(std::span<const TriangleOverEdge>(work).subspan(begin, end - begin));
        begin = end;
    }
}

} // namespace

EdgeSurvey survey_edges(Executor& executor, const IndexedMesh& mesh, bool with_locations) {
    const std::size_t n = mesh.triangles.size();
    EdgeSurvey survey{.parts = UnionFind(n), .open = PageArray<std::atomic<std::uint8_t>>(n, Fill::zero)};
    std::vector<Worker> workers(executor.workers());
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned w) {
        Worker& worker = workers[w];
        std::size_t up = 0;
        for (const EdgeUse& use : uses) {
            up += use.upwards() ? 1 : 0;
            survey.parts.join(uses[0].triangle, use.triangle);
        }
        const bool balanced = 2 * up == uses.size();
        const bool boundary = uses.size() == 1;
        const bool nonmanifold = uses.size() > 2;
        const bool conflict = !boundary && !balanced;
        if (!balanced)
            survey.open[uses[0].triangle].store(1, std::memory_order_relaxed);
        worker.counts.boundary_edges += boundary ? 1 : 0;
        worker.counts.nonmanifold_edges += nonmanifold ? 1 : 0;
        worker.counts.orientation_conflicts += conflict ? 1 : 0;
        for_each_same(mesh, uses, worker.triangles, [&](std::span<const TriangleOverEdge> group) {
            const auto same_way = static_cast<std::uint64_t>(std::count_if(
                group.begin(), group.end(), [](const TriangleOverEdge& t) { return t.upwards; }));
            worker.counts.duplicate_triangles += group.size() - 1;
            worker.opposite_pairs += std::min(same_way, group.size() - same_way);
            if (with_locations)
                for (const TriangleOverEdge& t : group.subspan(1))
                    worker.locations.duplicates.push_back(t.triangle);
        });
        if (!with_locations || !(boundary || nonmanifold || conflict))
            return;
        const VertexPair edge = ends_of(mesh, uses[0]);
        if (boundary)
            worker.locations.boundary.push_back(up == 1 ? VertexPair{edge.second, edge.first} : edge);
        if (nonmanifold)
            worker.locations.nonmanifold.push_back(edge);
        if (conflict)
            worker.locations.conflicts.push_back(edge);
    });
    for (const Worker& worker : workers) {
        add(survey.counts, worker.counts);
        survey.opposite_pairs += worker.opposite_pairs;
    }
    const auto gather = [&](auto EdgeLocations::*kind) {
        auto& all = survey.locations.*kind;
        for (const Worker& worker : workers)
            all.insert(all.end(), (worker.locations.*kind).begin(), (worker.locations.*kind).end());
        std::sort(all.begin(), all.end());
    };
    gather(&EdgeLocations::boundary);
    gather(&EdgeLocations::nonmanifold);
    gather(&EdgeLocations::conflicts);
    gather(&EdgeLocations::duplicates);
    assert(!with_locations || (survey.locations.boundary.size() == survey.counts.boundary_edges &&
                               survey.locations.nonmanifold.size() == survey.counts.nonmanifold_edges &&
                               survey.locations.conflicts.size() == survey.counts.orientation_conflicts &&
                               survey.locations.duplicates.size() == survey.counts.duplicate_triangles));
    assert(2 * survey.opposite_pairs <= n);
    return survey;
}

std::vector<std::vector<TriangleOverEdge>> find_same_vertices(Executor& executor, const IndexedMesh& mesh) {
    struct Found {
        std::vector<TriangleOverEdge> work;
        std::vector<std::vector<TriangleOverEdge>> groups;
    };
    std::vector<Found> found(executor.workers());
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned worker) {
        for_each_same(mesh, uses, found[worker].work, [&](std::span<const TriangleOverEdge> group) {
            found[worker].groups.emplace_back(group.begin(), group.end());
        });
    });
    std::vector<std::vector<TriangleOverEdge>> all;
    for (Found& part : found)
        std::move(part.groups.begin(), part.groups.end(), std::back_inserter(all));
    return all;
}

} // namespace lamella
