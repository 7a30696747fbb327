// Consistent orientation, in three steps:
//
//     flood   from the first triangle of each patch over edges of two triangles, noting which triangles run
//             against it; the smaller of both sets is turned
//     close   which patches are closed now, and what is around the edges where others are not
//     turn    patches as a whole, by their volumes and by what they lie in

#include "lamella/core/error.hpp"
#include "lamella/mesh/repair.hpp"

#include "core/executor.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/shells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace lamella {

namespace {

/// Over each side of a triangle its neighbour, where the edge has two triangles; the lowest bit tells that
/// both run the same way through it.
constexpr std::uint32_t no_neighbour = 0xffffffff;

PageArray<std::uint32_t> find_neighbours(Executor& executor, const IndexedMesh& mesh) {
    PageArray<std::uint32_t> neighbours(3 * mesh.triangles.size());
    executor.for_chunks(neighbours.size(), fold_piece, [&](std::size_t begin, std::size_t end, unsigned) {
        std::fill(neighbours.data() + begin, neighbours.data() + end, no_neighbour);
    });
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned) {
        if (uses.size() != 2)
            return;
        const std::uint32_t against = uses[0].upwards() == uses[1].upwards() ? 1 : 0;
        for (std::size_t k = 0; k < 2; ++k) {
            const auto& t = mesh.triangles[uses[k].triangle];
            const auto ends = ends_of(mesh, uses[k]);
            const std::uint32_t from = uses[k].upwards() ? ends.first : ends.second;
            const std::size_t side = t[0] == from ? 0 : t[1] == from ? 1 : 2;
            neighbours[std::size_t{3} * uses[k].triangle + side] = 2 * uses[1 - k].triangle + against;
        }
    });
    return neighbours;
}

struct Patches {
    Shells shells;            ///< the patches, as if they were shells
    std::vector<bool> turned; ///< triangles
    std::vector<bool> one_sided;
};

Patches flood(const IndexedMesh& mesh, const PageArray<std::uint32_t>& neighbours) {
    const std::size_t n = mesh.triangles.size();
    Patches patches;
    Shells& shells = patches.shells;
    shells.of_triangle = PageArray<std::uint32_t>(n);
    std::fill(shells.of_triangle.data(), shells.of_triangle.data() + n, no_shell);
    patches.turned.assign(n, false);
    std::vector<std::uint32_t> members;
    for (std::uint32_t start = 0; start < n; ++start) {
        if (shells.of_triangle[start] != no_shell || degenerate(mesh.triangles[start]))
            continue;
        const auto patch = static_cast<std::uint32_t>(shells.first.size());
        shells.first.push_back(start);
        shells.closed.push_back(true);
        patches.one_sided.push_back(false);
        members.assign(1, start);
        shells.of_triangle[start] = patch;
        std::size_t turned = 0;
        for (std::size_t next = 0; next < members.size(); ++next) {
            const std::uint32_t i = members[next];
            turned += patches.turned[i] ? 1 : 0;
            for (std::size_t side = 0; side < 3; ++side) {
                const std::uint32_t neighbour = neighbours[std::size_t{3} * i + side];
                if (neighbour == no_neighbour)
                    continue;
                const std::uint32_t j = neighbour / 2;
                const bool turn = patches.turned[i] != (neighbour % 2 != 0);
                if (shells.of_triangle[j] == no_shell) {
                    shells.of_triangle[j] = patch;
                    patches.turned[j] = turn;
                    members.push_back(j);
                } else if (patches.turned[j] != turn) {
                    patches.one_sided[patch] = true;
                }
            }
        }
        if (2 * turned > members.size())
            for (const std::uint32_t i : members)
                patches.turned[i] = !patches.turned[i];
    }
    return patches;
}

/// Marks patches that are not closed; the box around the ends of their open edges for each.
std::vector<Box3> find_open_edges(Executor& executor, const IndexedMesh& mesh, Patches& patches) {
    struct OpenEdge {
        std::uint32_t patch;
        std::uint32_t low;
        std::uint32_t high;
    };
    std::vector<std::vector<OpenEdge>> found(executor.workers());
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned worker) {
        if (uses.size() == 2 && uses[0].upwards() != uses[1].upwards())
            return;
        const auto [low, high] = ends_of(mesh, uses[0]);
        std::vector<std::pair<std::uint32_t, int>> balance; // by patch
        for (const EdgeUse& use : uses)
            balance.emplace_back(patches.shells.of_triangle[use.triangle], use.upwards() ? 1 : -1);
        std::sort(balance.begin(), balance.end());
        for (std::size_t begin = 0; begin < balance.size();) {
            int sum = 0;
            std::size_t end = begin;
            for (; end < balance.size() && balance[end].first == balance[begin].first; ++end)
                sum += balance[end].second;
            if (sum != 0)
                found[worker].push_back({balance[begin].first, low, high});
            begin = end;
        }
    });
    std::vector<Box3> boxes(patches.shells.size());
    for (const std::vector<OpenEdge>& part : found)
        for (const OpenEdge& edge : part) {
            patches.shells.closed[edge.patch] = false;
            boxes[edge.patch].add(mesh.vertices[edge.low]);
            boxes[edge.patch].add(mesh.vertices[edge.high]);
        }
    return boxes;
}

/// Signed volumes; of an open patch as if fans from the middle of the box around its open edges closed it.
std::vector<double> patch_volumes(const IndexedMesh& mesh, const Shells& patches,
                                  const std::vector<Box3>& open) {
    std::vector<Point3> origins(patches.size());
    for (std::size_t p = 0; p < patches.size(); ++p)
        origins[p] = open[p].empty() ? mesh.vertices[mesh.triangles[patches.first[p]][0]]
                                     : Point3{open[p].min.x / 2 + open[p].max.x / 2,
                                              open[p].min.y / 2 + open[p].max.y / 2,
                                              open[p].min.z / 2 + open[p].max.z / 2};
    std::vector<double> volumes(patches.size(), 0);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const std::uint32_t p = patches.of_triangle[i]; p != no_shell)
            volumes[p] += six_volumes(corners(mesh, i), origins[p]) / 6;
    return volumes;
}

bool holds(const Box3& outer, const Box3& inner) noexcept {
    Box3 both = outer;
    both.add(inner);
    return both == outer;
}

} // namespace

OrientedMesh orient(const IndexedMesh& mesh, const Execution& execution) {
    const std::size_t n = mesh.triangles.size();
    if (n > 0x7fffffff)
        throw Error(ErrorKind::limit,
                    fmt::format("cannot orient {} triangles: at most {} can be indexed", n, 0x7fffffff));
    Executor executor(execution);
    OrientedMesh result;
    result.mesh = mesh;
    Patches patches = flood(mesh, find_neighbours(executor, mesh));
    const auto turn = [&](std::size_t i) {
        std::swap(result.mesh.triangles[i][1], result.mesh.triangles[i][2]);
    };
    for (std::size_t i = 0; i < n; ++i)
        if (patches.turned[i])
            turn(i);

    const std::vector<Box3> open = find_open_edges(executor, result.mesh, patches);
    const std::vector<double> volumes = patch_volumes(result.mesh, patches.shells, open);
    const std::size_t count = patches.shells.size();
    std::vector<std::uint32_t> depth(count, 0);
    if (count > 1) {
        const std::vector<Box3> boxes = shell_boxes(result.mesh, patches.shells);
        for_each_enclosure(executor, result.mesh, patches.shells, boxes, std::vector<bool>(count, true),
                           [&](const Enclosure& enclosure) {
                               if (patches.shells.closed[enclosure.encloser] &&
                                   !patches.one_sided[enclosure.encloser] &&
                                   holds(boxes[enclosure.encloser], boxes[enclosure.shell]))
                                   ++depth[enclosure.shell];
                           });
    }
    std::vector<bool> turn_patch(count, false);
    for (std::size_t p = 0; p < count; ++p) {
        const bool inward = depth[p] % 2 != 0;
        result.one_sided_patches += patches.one_sided[p] ? 1 : 0;
        if (patches.one_sided[p] || volumes[p] == 0 || (volumes[p] < 0) == inward)
            continue;
        turn_patch[p] = true;
        ++(inward ? result.turned_inward : result.turned_outward);
    }
    result.patches = count;
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t p = patches.shells.of_triangle[i];
        if (p == no_shell)
            continue;
        if (turn_patch[p])
            turn(i);
        if (patches.turned[i] != turn_patch[p]) {
            ++result.turned_triangles;
            if (result.places.size() < repair_places)
                result.places.push_back(middle(corners(mesh, i)));
        } else {
            result.mesh.triangles[i] = mesh.triangles[i]; // turned twice: the same corner first again
        }
    }
    return result;
}

} // namespace lamella
