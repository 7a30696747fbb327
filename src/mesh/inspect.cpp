#include "lamella/mesh/inspect.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/union_find.hpp"
#include "mesh/winding.hpp"

#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::uint32_t no_shell = 0xffffffff;

Triangle3 corners(const IndexedMesh& mesh, std::size_t i) {
    const auto& t = mesh.triangles[i];
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

double area(const Triangle3& t) {
    const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
    const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
    const double x = u.y * v.z - u.z * v.y;
    const double y = u.z * v.x - u.x * v.z;
    const double z = u.x * v.y - u.y * v.x;
    return std::sqrt(x * x + y * y + z * z) / 2;
}

/// What the edges tell.
struct EdgeDefects {
    std::uint64_t boundary = 0;
    std::uint64_t nonmanifold = 0;
    std::uint64_t conflicts = 0;
    std::uint64_t duplicate_triangles = 0;

    void add(const EdgeDefects& other) {
        boundary += other.boundary;
        nonmanifold += other.nonmanifold;
        conflicts += other.conflicts;
        duplicate_triangles += other.duplicate_triangles;
    }
};

/// Triangles beyond the first with the same vertices, among those whose two lowest vertices this edge joins.
std::uint64_t duplicates(const IndexedMesh& mesh, std::span<const EdgeUse> uses,
                         std::vector<std::uint32_t>& highest) {
    highest.clear();
    for (const EdgeUse& use : uses)
        if (use.lowest_side()) {
            const auto& t = mesh.triangles[use.triangle];
            highest.push_back(std::max({t[0], t[1], t[2]}));
        }
    if (highest.size() < 2)
        return 0;
    std::sort(highest.begin(), highest.end());
    const auto distinct = std::unique(highest.begin(), highest.end()) - highest.begin();
    return highest.size() - static_cast<std::size_t>(distinct);
}

/// Connected parts of a mesh. The n-th shell is the one whose first triangle comes n-th in the mesh.
struct Shells {
    PageArray<std::uint32_t> of_triangle; ///< no_shell for a degenerate triangle
    std::vector<std::uint32_t> first;     ///< triangle of each shell
    std::vector<bool> closed;             ///< every edge is used as often one way as the other
};

Shells find_shells(Executor& executor, const IndexedMesh& mesh, const UnionFind& parts,
                   const PageArray<std::uint8_t>& open) {
    const std::size_t n = mesh.triangles.size();
    Shells shells;
    shells.of_triangle = PageArray<std::uint32_t>(n);
    executor.for_chunks(n, fold_piece, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            shells.of_triangle[i] =
                degenerate(mesh.triangles[i]) ? no_shell : parts.find(static_cast<std::uint32_t>(i));
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
        if (open[i] != 0)
            shells.closed[shell] = false;
    }
    return shells;
}

/// The signed volume of every shell, measured from its own first corner: a small shell far away keeps its
/// sign.
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
    std::vector<double> volumes(shells.first.size(), 0);
    (void)fold(executor, mesh.triangles.size(), Runs{}, piece, [&](Runs&, const Runs& runs) {
        for (const auto& [shell, six] : runs)
            volumes[shell] += six / 6;
    });
    return volumes;
}

/// Tells cavities from shells that are turned inside out: a cavity lies in the material of the others.
void judge_inward_shells(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                         Inspection& found) {
    const std::vector<double> volumes = shell_volumes(executor, mesh, shells);
    struct Inward {
        std::uint32_t shell;
        double area;
        Point3 middle; ///< of its largest triangle: well away from the edges where shells touch
    };
    std::vector<Inward> inward;
    std::vector<std::uint32_t> place(volumes.size(), no_shell);
    for (std::uint32_t s = 0; s < volumes.size(); ++s)
        if (shells.closed[s] && volumes[s] < 0) {
            place[s] = static_cast<std::uint32_t>(inward.size());
            inward.push_back({s, -1, {}});
        }
    if (inward.empty())
        return;
    if (volumes.size() == 1) {
        found.inverted_shells = 1;
        return;
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t s = shells.of_triangle[i];
        if (s == no_shell || place[s] == no_shell)
            continue;
        Inward& shell = inward[place[s]];
        const Triangle3 t = corners(mesh, i);
        if (const double size = area(t); size > shell.area) {
            shell.area = size;
            shell.middle = {(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3,
                            (t[0].z + t[1].z + t[2].z) / 3};
        }
    }
    std::vector<Point3> points;
    points.reserve(inward.size());
    for (const Inward& shell : inward)
        points.push_back(shell.middle);
    const std::vector<int> windings =
        winding_numbers(executor, mesh, points, [&](std::size_t point, std::size_t triangle) {
            const std::uint32_t shell = shells.of_triangle[triangle];
            return shell != inward[point].shell && shell != no_shell;
        });
    for (const int winding : windings)
        ++(winding > 0 ? found.cavities : found.inverted_shells);
}

} // namespace

Inspection inspect(const IndexedMesh& mesh, const Execution& execution) {
    Executor executor(execution);
    const std::size_t n = mesh.triangles.size();
    Inspection found;
    found.triangles = n;
    found.vertices = mesh.vertices.size();
    found.box = bounding_box(mesh, execution);

    struct Sums {
        double area = 0;
        std::uint64_t degenerate = 0;
    };
    const auto piece = [&](std::size_t begin, std::size_t end) {
        Sums sums;
        for (std::size_t i = begin; i < end; ++i) {
            sums.area += area(corners(mesh, i));
            sums.degenerate += degenerate(mesh.triangles[i]) ? 1 : 0;
        }
        return sums;
    };
    const Sums sums = fold(executor, n, Sums{}, piece, [](Sums& total, const Sums& part) {
        total.area += part.area;
        total.degenerate += part.degenerate;
    });
    found.area_mm2 = sums.area;
    found.degenerate_triangles = sums.degenerate;
    found.volume_mm3 = fold_volume(executor, n, [&](std::size_t i) { return corners(mesh, i); });

    struct Worker {
        EdgeDefects defects;
        std::vector<std::uint32_t> highest;
    };
    std::vector<Worker> workers(executor.workers());
    const UnionFind parts(n);
    const PageArray<std::uint8_t> open(n,
                                       Fill::zero); // 1 for some triangle at each edge that is not balanced
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned w) {
        Worker& worker = workers[w];
        std::size_t up = 0;
        for (const EdgeUse& use : uses) {
            up += use.upwards() ? 1 : 0;
            parts.join(uses[0].triangle, use.triangle);
        }
        const bool balanced = 2 * up == uses.size();
        if (!balanced)
            std::atomic_ref<std::uint8_t>(open[uses[0].triangle]).store(1, std::memory_order_relaxed);
        worker.defects.boundary += uses.size() == 1 ? 1 : 0;
        worker.defects.nonmanifold += uses.size() > 2 ? 1 : 0;
        worker.defects.conflicts += uses.size() > 1 && !balanced ? 1 : 0;
        worker.defects.duplicate_triangles += duplicates(mesh, uses, worker.highest);
    });
    EdgeDefects defects;
    for (const Worker& worker : workers)
        defects.add(worker.defects);
    found.boundary_edges = defects.boundary;
    found.nonmanifold_edges = defects.nonmanifold;
    found.orientation_conflicts = defects.conflicts;
    found.duplicate_triangles = defects.duplicate_triangles;

    const Shells shells = find_shells(executor, mesh, parts, open);
    found.shells = shells.first.size();
    judge_inward_shells(executor, mesh, shells, found);
    return found;
}

} // namespace lamella
