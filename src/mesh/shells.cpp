#include "mesh/shells.hpp"

#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/winding.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <span>
#include <utility>

namespace lamella {

Shells find_shells(Executor& executor, const IndexedMesh& mesh, const EdgeSurvey& survey) {
    const std::size_t n = mesh.triangles.size();
    Shells shells;
    shells.of_triangle = PageArray<std::uint32_t>(n);
    executor.for_chunks(n, fold_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            shells.of_triangle[i] =
                degenerate(mesh.triangles[i]) ? no_shell : survey.parts.find(static_cast<std::uint32_t>(i));
    });
    // A set is identified by its lowest member, which comes first, so that its number is known when the
    // others follow.
    for (std::size_t i = 0; i < n; ++i) {
        std::uint32_t& shell = shells.of_triangle[i];
        if (shell == no_shell)
            continue;
        if (shell == i) {
            shell = static_cast<std::uint32_t>(shells.first.size());
            shells.first.push_back(static_cast<std::uint32_t>(i));
            shells.closed.push_back(true);
        } else {
            assert(shell < i);
            shell = shells.of_triangle[shell];
        }
        if (survey.open[i] != 0)
            shells.closed[shell] = false;
    }
    assert(shells.closed.size() == shells.first.size());
    assert(std::is_sorted(shells.first.begin(), shells.first.end()));
    return shells;
}

void ShellContent::add(const ShellContent& other) noexcept {
    six_volumes += other.six_volumes;
    sizes += other.sizes;
    triangles += other.triangles;
}

std::vector<ShellContent> shell_contents(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                                         std::span<const Point3> origins) {
    assert(origins.size() == shells.size() && shells.of_triangle.size() == mesh.triangles.size());
    const auto six_volumes_by_normal = [&](const Triangle3& t, const Point3& origin) {
        const Point3 n = normal(t);
        return (t[0].x - origin.x) * n.x + (t[0].y - origin.y) * n.y + (t[0].z - origin.z) * n.z;
    };
    const auto carefully = [&](std::size_t i) -> ShellContent {
        const Triangle3 t = in_order(corners(mesh, i));
        const Point3& origin = origins[shells.of_triangle[i]];
        const double six = six_volumes_by_normal(t, origin);
        return {runs_in_order(corners(mesh, i)) ? six : -six,
                distance(t[0], origin) * distance(t[0], t[1]) * distance(t[0], t[2]), 1};
    };
    // Takes half the time of an exact computation. Its `sizes` are upper bounds, which suffice for nearly all
    // shells.
    const auto roughly = [&](std::size_t i) -> ShellContent {
        const auto way = [](const Point3& a, const Point3& b) {
            return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
        };
        const Triangle3 t = corners(mesh, i);
        const Point3& origin = origins[shells.of_triangle[i]];
        const double side = std::max({way(t[0], t[1]), way(t[1], t[2]), way(t[2], t[0])});
        return {six_volumes_by_normal(t, origin), (way(t[0], origin) + side) * side * side, 1};
    };
    // Consecutive triangles of one shell each.
    using Contents = std::vector<std::pair<std::uint32_t, ShellContent>>;
    const auto piece = [&](std::size_t begin, std::size_t end) {
        Contents runs;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t shell = shells.of_triangle[i];
            if (shell == no_shell)
                continue;
            if (runs.empty() || runs.back().first != shell)
                runs.push_back({shell, {}});
            runs.back().second.add(roughly(i));
        }
        return runs;
    };
    std::vector<ShellContent> contents(shells.size());
    (void)fold(executor, mesh.triangles.size(), Contents{}, piece, [&](Contents&, const Contents& runs) {
        for (const auto& [shell, some] : runs)
            contents[shell].add(some);
    });
    // Another order of the terms changes a sum by up to twice its rounding error. Sums close to 0 are
    // therefore computed again in a fixed order.
    std::vector<bool> close(shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s)
        close[s] = std::abs(contents[s].six_volumes) <= 3 * contents[s].rounding();
    Contents summands;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const std::uint32_t shell = shells.of_triangle[i]; shell != no_shell && close[shell]) {
            contents[shell] = {};
            summands.emplace_back(shell, carefully(i));
        }
    std::sort(summands.begin(), summands.end());
    for (const auto& [shell, some] : summands)
        contents[shell].add(some);
    return contents;
}

std::vector<Box3> shell_boxes(const IndexedMesh& mesh, const Shells& shells) {
    assert(shells.of_triangle.size() == mesh.triangles.size());
    std::vector<Box3> boxes(shells.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const std::uint32_t shell = shells.of_triangle[i]; shell != no_shell)
            for (const Point3& p : corners(mesh, i))
                boxes[shell].add(p);
    return boxes;
}

void for_each_enclosure(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                        const std::vector<Box3>& boxes, const std::vector<bool>& asked,
                        const std::function<void(const Enclosure&)>& visit) {
    assert(boxes.size() == shells.size() && asked.size() == shells.size());
    std::vector<double> largest(shells.size(), -1);
    // The largest triangle of each shell; of equal ones, the lexicographically smallest.
    std::vector<Triangle3> first(shells.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t shell = shells.of_triangle[i];
        if (shell == no_shell || !asked[shell])
            continue;
        const Triangle3 t = in_order(corners(mesh, i));
        if (const double size = area(t);
            size > largest[shell] || (size == largest[shell] && t < first[shell])) {
            largest[shell] = size;
            first[shell] = t;
        }
    }
    std::vector<Point3> points;
    std::vector<std::uint32_t> shell_of_point;
    for (std::uint32_t s = 0; s < shells.size(); ++s)
        if (asked[s]) {
            assert(largest[s] >= 0); // each shell has a triangle
            points.push_back(middle(first[s]));
            shell_of_point.push_back(s);
        }
    const auto holds = [](const Box3& box, const Point3& p) {
        return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y &&
               box.min.z <= p.z && p.z <= box.max.z;
    };
    // Nested shells have as many hits as there are pairs of shells. At most this many hits are kept at a
    // time, unless a single point has more.
    const std::uint64_t most_hits = std::max<std::uint64_t>(std::uint64_t{1} << 20, mesh.triangles.size());
    std::vector<std::vector<Enclosure>> hits(executor.workers());
    std::vector<std::atomic<std::uint32_t>> hits_of_point(points.size());
    std::atomic<std::uint64_t> found{0};
    const auto find = [&](std::size_t begin, std::size_t end) {
        found = 0;
        const auto keep = [&](std::size_t place, std::size_t triangle, int winding, unsigned worker) {
            const std::size_t point = begin + place;
            const std::uint32_t shell = shells.of_triangle[triangle];
            const std::uint32_t own = shell_of_point[point];
            if (shell == no_shell || shell == own || !holds(boxes[shell], points[point]))
                return;
            hits_of_point[point].fetch_add(1, std::memory_order_relaxed);
            if (found.fetch_add(1, std::memory_order_relaxed) < most_hits)
                hits[worker].push_back({own, shell, winding});
        };
        for_triangles_above(executor, mesh, std::span(points).subspan(begin, end - begin), keep);
    };
    const auto report_progress = [&] {
        std::vector<Enclosure> all;
        for (std::vector<Enclosure>& part : hits) {
            all.insert(all.end(), part.begin(), part.end());
            part.clear();
        }
        std::sort(all.begin(), all.end());
        for (auto hit = all.begin(); hit != all.end();) {
            Enclosure sum = *hit++;
            for (; hit != all.end() && hit->shell == sum.shell && hit->encloser == sum.encloser; ++hit)
                sum.winding += hit->winding;
            if (sum.winding != 0)
                visit(sum);
        }
    };
    find(0, points.size());
    if (found <= most_hits) {
        report_progress();
        return;
    }
    // There are too many hits for one pass, but now the number of hits of each point is known.
    const std::vector<std::uint32_t> counts(hits_of_point.begin(), hits_of_point.end());
    std::size_t end = 0;
    for (std::size_t begin = 0; begin < points.size(); begin = end) {
        executor.check_cancelled();
        for (std::uint64_t sum = 0; end < points.size() && (end == begin || sum + counts[end] <= most_hits);)
            sum += counts[end++];
        for (std::vector<Enclosure>& part : hits)
            part.clear();
        find(begin, end);
        report_progress();
    }
}

} // namespace lamella
