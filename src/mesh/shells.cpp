#include "mesh/shells.hpp"

#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/winding.hpp"

#include <algorithm>
#include <atomic>
#include <span>

namespace lamella {

Shells find_shells(Executor& executor, const IndexedMesh& mesh, const EdgeSurvey& survey) {
    const std::size_t n = mesh.triangles.size();
    Shells shells;
    shells.of_triangle = PageArray<std::uint32_t>(n);
    executor.for_chunks(n, fold_piece, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            shells.of_triangle[i] =
                degenerate(mesh.triangles[i]) ? no_shell : survey.parts.find(static_cast<std::uint32_t>(i));
    });
    // A set is named by its lowest member, so that comes first, and can hand its number to the others.
    for (std::size_t i = 0; i < n; ++i) {
        std::uint32_t& shell = shells.of_triangle[i];
        if (shell == no_shell)
            continue;
        if (shell == i) {
            shell = static_cast<std::uint32_t>(shells.first.size());
            shells.first.push_back(static_cast<std::uint32_t>(i));
            shells.closed.push_back(true);
        } else {
            shell = shells.of_triangle[shell];
        }
        if (survey.open[i] != 0)
            shells.closed[shell] = false;
    }
    return shells;
}

std::vector<double> shell_volumes(Executor& executor, const IndexedMesh& mesh, const Shells& shells) {
    using Runs = std::vector<std::pair<std::uint32_t, double>>; // stretches of one shell, in order
    const auto piece = [&](std::size_t begin, std::size_t end) {
        Runs runs;
        Point3 origin;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t shell = shells.of_triangle[i];
            if (shell == no_shell)
                continue;
            if (runs.empty() || runs.back().first != shell) {
                runs.emplace_back(shell, 0.0);
                origin = mesh.vertices[mesh.triangles[shells.first[shell]][0]];
            }
            runs.back().second += six_volumes(corners(mesh, i), origin);
        }
        return runs;
    };
    std::vector<double> volumes(shells.size(), 0);
    (void)fold(executor, mesh.triangles.size(), Runs{}, piece, [&](Runs&, const Runs& runs) {
        for (const auto& [shell, six] : runs)
            volumes[shell] += six / 6;
    });
    return volumes;
}

std::vector<Box3> shell_boxes(const IndexedMesh& mesh, const Shells& shells) {
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
    std::vector<double> largest(shells.size(), -1);
    std::vector<Triangle3> first(shells.size()); // of those
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
            points.push_back(middle(first[s]));
            shell_of_point.push_back(s);
        }
    const auto holds = [](const Box3& box, const Point3& p) {
        return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y &&
               box.min.z <= p.z && p.z <= box.max.z;
    };
    // Shells in one another have as many hits as pairs. So many are kept at a time; of one point there are
    // never more.
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
    const auto tell = [&] {
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
        tell();
        return;
    }
    // Too many for once, but now it is known how many each point has.
    const std::vector<std::uint32_t> counts(hits_of_point.begin(), hits_of_point.end());
    std::size_t end = 0;
    for (std::size_t begin = 0; begin < points.size(); begin = end) {
        executor.check_cancelled();
        for (std::uint64_t sum = 0; end < points.size() && (end == begin || sum + counts[end] <= most_hits);)
            sum += counts[end++];
        for (std::vector<Enclosure>& part : hits)
            part.clear();
        find(begin, end);
        tell();
    }
}

} // namespace lamella
