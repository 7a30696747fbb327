#include "lamella/mesh/self_intersections.hpp"

#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/triangle_contact.hpp"
#include "mesh/valid_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    IntersectionKind kind;

    friend bool operator<(const Pair& p, const Pair& q) noexcept {
        return std::pair(p.a, p.b) < std::pair(q.a, q.b);
    }
};

/// Adds a pair to a heap of the `keep` lowest pairs so far, with the greatest of them on top.
void add_to(std::vector<Pair>& first, const Pair& pair, std::size_t keep) {
    if (first.size() >= keep) {
        if (keep == 0 || !(pair < first.front()))
            return;
        std::pop_heap(first.begin(), first.end());
        first.pop_back();
    }
    first.push_back(pair);
    std::push_heap(first.begin(), first.end());
}

/// Pairs found so far. Without parts, all triangles are of part 0.
struct Found {
    std::vector<Pair> through; ///< the first that cross or overlap
    std::vector<Pair> beside;  ///< the first that touch
    /// Number of pairs of each kind.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::uint64_t, 3>> parts;

    void add(const Pair& pair, const IntersectionOptions& options) {
        add_to(pair.kind == IntersectionKind::touching ? beside : through, pair, options.keep);
        const auto part_of = [&](std::uint32_t triangle) {
            return options.parts.empty() ? 0U : options.parts[triangle];
        };
        ++parts[std::minmax({part_of(pair.a), part_of(pair.b)})][static_cast<std::size_t>(pair.kind)];
    }
};

NamedTriangle named(const IndexedMesh& mesh, std::uint32_t i) {
    return {corners(mesh, i), mesh.triangles[i]};
}

} // namespace

SelfIntersections find_self_intersections(const IndexedMesh& mesh, const IntersectionOptions& options,
                                          const Execution& execution) {
    Executor executor(execution);
    SelfIntersections result;
    const std::size_t n = mesh.triangles.size();
    if (!options.parts.empty() && options.parts.size() != n)
        throw Error(
            ErrorKind::usage,
            fmt::format(
                "IntersectionOptions::parts has {} numbers and the mesh {} triangles; it needs one for each",
                options.parts.size(), n));

    check(mesh, executor);
    const PageArray<std::uint8_t> without_area(n, Fill::zero);
    const auto piece = [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i)
            if (degenerate(mesh.triangles[i]) || flat(corners(mesh, i))) {
                without_area[i] = 1;
                ++count;
            }
        return count;
    };
    result.flat_triangles = fold(executor, n, std::uint64_t{0}, piece,
                                 [](std::uint64_t& total, std::uint64_t count) { total += count; });

    const BoxTree tree(executor, mesh, fold_box(executor, mesh.vertices),
                       [&](std::uint32_t i) { return without_area[i] == 0; });
    std::vector<Found> found(executor.workers());
    constexpr std::size_t leaves_at_once = 256;
    const auto search = [&](std::size_t first_leaf, std::size_t last_leaf, unsigned worker) {
        std::vector<ContactSeeker> seekers;
        for (std::size_t leaf = first_leaf; leaf < last_leaf && !executor.stopping(); ++leaf) {
            const auto [begin, end] = tree.positions(leaf);
            seekers.clear();
            for (std::size_t position = begin; position < end; ++position)
                seekers.emplace_back(named(mesh, tree.triangle(position)));
            tree.close_to_leaf(leaf, [&, first = begin](std::size_t point_a, std::size_t point_b) {
                const std::uint32_t a = tree.triangle(point_a);
                const std::uint32_t b = tree.triangle(point_b);
                if (const std::optional<IntersectionKind> kind =
                        seekers[point_a - first].with(named(mesh, b)))
                    found[worker].add({std::min(a, b), std::max(a, b), *kind}, options);
            });
        }
    };
    executor.for_chunks(tree.leaves(), leaves_at_once, search);
    executor.check_cancelled();

    Found all;
    for (const Found& part : found) {
        for (const Pair& pair : part.through)
            add_to(all.through, pair, options.keep);
        for (const Pair& pair : part.beside)
            add_to(all.beside, pair, options.keep);
        for (const auto& [parts, counts] : part.parts)
            for (std::size_t kind = 0; kind < counts.size(); ++kind)
                all.parts[parts][kind] += counts[kind];
    }
    for (std::vector<Pair>* first : {&all.through, &all.beside}) {
        std::sort(first->begin(), first->end());
        for (const Pair& pair : *first)
            result.first.push_back({pair.a, pair.b, pair.kind,
                                    contact_point(corners(mesh, pair.a), corners(mesh, pair.b), pair.kind)});
    }
    for (const auto& [parts, counts] : all.parts) {
        const auto& [crossing, overlapping, touching] = counts;
        result.crossing += crossing;
        result.overlapping += overlapping;
        result.touching += touching;
        if (!options.parts.empty())
            result.parts.push_back({parts.first, parts.second, crossing, overlapping, touching});
    }
    return result;
}

} // namespace lamella
