#include "lamella/mesh/diagnose.hpp"

#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "mesh/coordinate_rounding.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/survey.hpp"
#include "mesh/union_find.hpp"
#include "mesh/valid_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// Joins directed edges, given in ascending order, end to end into loops that pass no vertex twice. Edges
/// that do not close form chains. Calls visit(vertices, closed).
template <class Visit>
void for_each_loop(const std::vector<VertexPair>& edges, const Visit& visit) {
    // Edges that start at the same vertex are consecutive; data of a vertex is stored at the first of them.
    const auto first_of = [&](std::uint32_t vertex) {
        return static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), VertexPair{vertex, 0}) -
                                        edges.begin());
    };
    std::vector<std::uint32_t> used(edges.size(), 0); // number of used edges of a vertex
    std::vector<std::uint32_t> arrivals;
    for (const VertexPair& edge : edges)
        arrivals.push_back(edge.second);
    std::sort(arrivals.begin(), arrivals.end());
    std::vector<std::uint32_t> path;
    // Position of a vertex in the path; a vertex without outgoing edges ends the path.
    constexpr std::uint32_t nowhere = 0xffffffff;
    std::vector<std::uint32_t> position(edges.size(), nowhere);
    const auto walk_from = [&](std::uint32_t start) {
        path.clear();
        for (std::uint32_t vertex = start;;) {
            const std::size_t first = first_of(vertex);
            const bool leaves = first < edges.size() && edges[first].first == vertex;
            if (leaves && position[first] != nowhere) {
                const std::uint32_t from = position[first];
                visit(std::span<const std::uint32_t>(path).subspan(from), true);
                for (std::size_t i = from; i < path.size(); ++i)
                    position[first_of(path[i])] = nowhere;
                path.resize(from);
            }
            const std::size_t next = first + (leaves ? used[first] : 0);
            path.push_back(vertex);
            if (!leaves || next >= edges.size() || edges[next].first != vertex)
                break;
            position[first] = static_cast<std::uint32_t>(path.size() - 1);
            ++used[first];
            vertex = edges[next].second;
        }
        for (const std::uint32_t vertex : path)
            if (const std::size_t first = first_of(vertex);
                first < edges.size() && edges[first].first == vertex)
                position[first] = nowhere;
        if (path.size() > 1)
            visit(std::span<const std::uint32_t>(path), false);
    };
    // Chains come first: they start at vertices with more outgoing than incoming edges.
    for (std::size_t begin = 0; begin < edges.size();) {
        const std::uint32_t vertex = edges[begin].first;
        std::size_t end = begin;
        while (end < edges.size() && edges[end].first == vertex)
            ++end;
        const auto [from, to] = std::equal_range(arrivals.begin(), arrivals.end(), vertex);
        for (auto more = static_cast<std::ptrdiff_t>(end - begin) - (to - from); more > 0; --more)
            walk_from(vertex);
        begin = end;
    }
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (const std::size_t first = first_of(edges[i].first); first + used[first] <= i)
            walk_from(edges[i].first);
}

double width_of(const std::vector<Point3>& points) {
    const Point3& first = points.front();
    const auto from_first = [&](const Point3& p) {
        return Point3{p.x - first.x, p.y - first.y, p.z - first.z};
    };
    const Point3 line =
        from_first(*std::max_element(points.begin(), points.end(), [&](const Point3& a, const Point3& b) {
            return distance(first, a) < distance(first, b);
        }));
    const double length = std::sqrt(line.x * line.x + line.y * line.y + line.z * line.z);
    double width = 0;
    for (const Point3& p : points) {
        const Point3 v = from_first(p);
        const Point3 n{v.y * line.z - v.z * line.y, v.z * line.x - v.x * line.z, v.x * line.y - v.y * line.x};
        width = std::max(width, std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / length);
    }
    return length > 0 ? width : 0;
}

void find_loops(const IndexedMesh& mesh, const std::vector<VertexPair>& edges, Diagnosis& found) {
    const double rounding = coordinate_rounding(found.counts.box);
    for_each_loop(edges, [&](std::span<const std::uint32_t> vertices, bool closed) {
        BoundaryLoop loop;
        loop.closed = closed;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const Point3& p = mesh.vertices[vertices[i]];
            if (i > 0)
                loop.length_mm += distance(loop.points.back(), p);
            loop.points.push_back(p);
            loop.box.add(p);
        }
        if (closed)
            loop.length_mm += distance(loop.points.back(), loop.points.front());
        loop.width_mm = width_of(loop.points);
        if (closed && loop.width_mm <= rounding) {
            ++found.slits;
            found.widest_slit_mm = std::max(found.widest_slit_mm, loop.width_mm);
        }
        ++found.boundary_loops;
        found.boundary_length_mm += loop.length_mm;
        found.loops.push_back(std::move(loop));
    });
    std::stable_sort(found.loops.begin(), found.loops.end(),
                     [](const BoundaryLoop& a, const BoundaryLoop& b) {
                         return std::tuple(-a.length_mm, a.box.min) < std::tuple(-b.length_mm, b.box.min);
                     });
}

/// Groups the corners of triangles at each vertex by their common edges. At vertices with more than one group
/// of corners, parts of the surface touch.
void find_nonmanifold_vertices(Executor& executor, const IndexedMesh& mesh, std::size_t keep,
                               Diagnosis& found) {
    const std::size_t n = mesh.triangles.size();
    if (n > 0xffffffff / 3)
        throw Error(ErrorKind::limit, fmt::format("cannot diagnose {} triangles: at most {} can be indexed",
                                                  n, 0xffffffffU / 3));
    const UnionFind groups(3 * n);
    const auto corner_at = [&](std::uint32_t triangle, std::uint32_t vertex) {
        const auto& t = mesh.triangles[triangle];
        return 3 * triangle + (t[0] == vertex ? 0U : t[1] == vertex ? 1U : 2U);
    };
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned) {
        const auto [low, high] = ends_of(mesh, uses[0]);
        for (const EdgeUse& use : uses.subspan(1))
            for (const std::uint32_t vertex : {low, high})
                groups.join(corner_at(uses[0].triangle, vertex), corner_at(use.triangle, vertex));
    });
    std::vector<std::uint8_t> seen(mesh.vertices.size(), 0); // 1: one group, 2: more
    for (std::size_t i = 0; i < n; ++i) {
        if (degenerate(mesh.triangles[i]))
            continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto corner = static_cast<std::uint32_t>(3 * i + k);
            if (groups.find(corner) != corner)
                continue;
            std::uint8_t& groups_seen = seen[mesh.triangles[i][k]];
            if (groups_seen < 2)
                ++groups_seen;
        }
    }
    for (std::size_t v = 0; v < seen.size(); ++v)
        if (seen[v] > 1) {
            if (found.vertices.size() < keep)
                found.vertices.push_back(mesh.vertices[v]);
            ++found.nonmanifold_vertices;
        }
}

std::vector<Shell> report_shells(const Survey& all, const IndexedMesh& mesh) {
    std::vector<Shell> shells(all.shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s) {
        Shell& shell = shells[s];
        shell.first_triangle = all.shells.first[s];
        shell.box = all.boxes[s];
        shell.volume_mm3 = all.contents[s].volume();
        shell.kind = !all.shells.closed[s] ? ShellKind::open
                     : !all.inward[s]      ? ShellKind::body
                     : all.cavity[s]       ? ShellKind::cavity
                                           : ShellKind::inverted;
        shell.depth = all.depth[s];
        if (all.inside[s] != no_shell)
            shell.inside = all.inside[s];
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const std::uint32_t s = all.shells.of_triangle[i]; s != no_shell)
            ++shells[s].triangles;
    return shells;
}

} // namespace

std::string_view shell_kind_name(ShellKind kind) noexcept {
    constexpr std::array names{"body", "cavity", "inverted", "open"};
    assert(static_cast<std::size_t>(kind) < names.size());
    return names[static_cast<std::size_t>(kind)];
}

Diagnosis diagnose(const IndexedMesh& mesh, const DiagnosisOptions& options, const Execution& execution) {
    Executor executor(execution);
    check(mesh, executor);
    Diagnosis found;
    const Survey all = survey(executor, mesh, true);
    found.counts = all.found;
    found.opposite_pairs = all.opposite_pairs;

    const auto keep_first = [&](auto& positions) {
        if (positions.size() > options.keep)
            positions.resize(options.keep);
    };
    find_loops(mesh, all.locations.boundary, found);
    keep_first(found.loops);
    const auto keep_edges = [&](const std::vector<VertexPair>& edges, std::vector<EdgeLocation>& kept) {
        for (std::size_t i = 0; i < std::min(edges.size(), options.keep); ++i)
            kept.push_back({mesh.vertices[edges[i].first], mesh.vertices[edges[i].second]});
    };
    keep_edges(all.locations.nonmanifold, found.nonmanifold_edges);
    keep_edges(all.locations.conflicts, found.conflicting_edges);
    found.duplicate_triangles = all.locations.duplicates;
    keep_first(found.duplicate_triangles);
    for (std::uint32_t i = 0; i < mesh.triangles.size() && found.degenerate_triangles.size() < options.keep &&
                              found.degenerate_triangles.size() < found.counts.degenerate_triangles;
         ++i)
        if (degenerate(mesh.triangles[i]))
            found.degenerate_triangles.push_back(i);
    find_nonmanifold_vertices(executor, mesh, options.keep, found);

    found.shells = report_shells(all, mesh);
    keep_first(found.shells);
    if (options.self_intersections)
        found.self_intersections = find_self_intersections(
            mesh, {.keep = options.keep, .parts = all.shells.of_triangle.span()}, execution);
    return found;
}

} // namespace lamella
