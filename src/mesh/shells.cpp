#include "mesh/shells.hpp"

#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/winding.hpp"

#include <algorithm>

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

std::vector<Enclosure> find_enclosures(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                                       const std::vector<Box3>& boxes, const std::vector<bool>& asked) {
    std::vector<double> largest(shells.size(), -1);
    std::vector<Point3> middles(shells.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t shell = shells.of_triangle[i];
        if (shell == no_shell || !asked[shell])
            continue;
        const Triangle3 t = corners(mesh, i);
        if (const double size = area(t); size > largest[shell]) {
            largest[shell] = size;
            middles[shell] = middle(t);
        }
    }
    std::vector<Point3> points;
    std::vector<std::uint32_t> shell_of_point;
    for (std::uint32_t s = 0; s < shells.size(); ++s)
        if (asked[s]) {
            points.push_back(middles[s]);
            shell_of_point.push_back(s);
        }
    const auto holds = [](const Box3& box, const Point3& p) {
        return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y &&
               box.min.z <= p.z && p.z <= box.max.z;
    };
    std::vector<std::vector<Enclosure>> hits(executor.workers());
    for_triangles_above(executor, mesh, points,
                        [&](std::size_t point, std::size_t triangle, int winding, unsigned worker) {
                            const std::uint32_t shell = shells.of_triangle[triangle];
                            const std::uint32_t own = shell_of_point[point];
                            if (shell != no_shell && shell != own && holds(boxes[shell], points[point]))
                                hits[worker].push_back({own, shell, winding});
                        });
    std::vector<Enclosure> all;
    for (const std::vector<Enclosure>& part : hits)
        all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    std::vector<Enclosure> enclosures;
    for (const Enclosure& hit : all) {
        if (!enclosures.empty() && enclosures.back().shell == hit.shell &&
            enclosures.back().encloser == hit.encloser)
            enclosures.back().winding += hit.winding;
        else
            enclosures.push_back(hit);
    }
    std::erase_if(enclosures, [](const Enclosure& e) { return e.winding == 0; });
    return enclosures;
}

} // namespace lamella
