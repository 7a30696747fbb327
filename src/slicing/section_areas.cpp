#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"
#include "slicing/edge_cut.hpp"
#include "slicing/ranks.hpp"
#include "slicing/section_moments.hpp"

#include <algorithm>
#include <array>

namespace lamella {

namespace {

/// Adds the moments of the areas that the cut segments of the triangles [begin, end) sweep around `origin`.
void add_sections(const Mesh& mesh, const Ranks& ranks, const Point2& origin, std::uint64_t begin,
                  std::uint64_t end, std::vector<AreaMoments>& sections) {
    const bool above = ranks.rule() == PlaneRule::section_above;
    for (std::uint64_t i = begin; i < end; ++i) {
        const Triangle3 corner = mesh.triangle(i);
        std::array<std::uint32_t, 3> rank;
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks(corner[k].z);
        const std::uint32_t first = std::min({rank[0], rank[1], rank[2]});
        const std::uint32_t last = std::max({rank[0], rank[1], rank[2]});
        for (std::uint32_t plane = first; plane < last; ++plane) {
            // Material is on the left of a segment from the edge that runs downwards to the one that runs
            // upwards.
            Point2 from;
            Point2 to;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t k1 = (k + 1) % 3;
                const bool starts_above = rank[k] > plane;
                const bool ends_above = rank[k1] > plane;
                if (starts_above == ends_above)
                    continue;
                const Point3& low = starts_above ? corner[k1] : corner[k];
                const Point3& high = starts_above ? corner[k] : corner[k1];
                const EdgeCut edge =
                    above ? EdgeCut(low, high, ranks.snap_mm()) : EdgeCut(high, low, ranks.snap_mm());
                (starts_above ? from : to) = edge.at(ranks.z(plane));
            }
            sections[plane].add_edge(from, to, origin);
        }
    }
}

} // namespace

std::vector<AreaMoments> section_moments(const Mesh& mesh, const Plan& plan, const Point2& origin,
                                         const Execution& execution) {
    const Ranks ranks(plan);
    Executor executor(execution);
    std::vector<AreaMoments> sections(ranks.count());
    // Number and order of the chunks do not depend on the threads, so the bits of the sums do not, either.
    constexpr std::uint64_t most = (std::uint64_t{32} << 20) / sizeof(AreaMoments); // 32 MB in all
    const std::uint64_t pieces = std::clamp<std::uint64_t>(most / (sections.size() + 1), 1, 64);
    const std::uint64_t n = mesh.size();
    const std::uint64_t piece = n / pieces + 1;
    std::vector<std::vector<AreaMoments>> parts(pieces);
    executor.for_chunks(pieces, 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t p = begin; p < end; ++p) {
            parts[p].resize(ranks.count());
            add_sections(mesh, ranks, origin, std::min(n, p * piece), std::min(n, (p + 1) * piece), parts[p]);
        }
    });
    for (const std::vector<AreaMoments>& part : parts)
        for (std::size_t i = 0; i < sections.size(); ++i)
            sections[i].add(part[i]);
    return sections;
}

std::vector<double> section_areas(const Mesh& mesh, const Plan& plan, const Execution& execution) {
    const Box3 box = bounding_box(mesh, execution);
    if (box.empty())
        return std::vector<double>(plan.layers.size());
    // Moments around the middle of the part are accurate even if the part is far from the origin.
    const Point2 origin{(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2};
    std::vector<double> areas;
    for (const AreaMoments& section : section_moments(mesh, plan, origin, execution))
        areas.push_back(section.area_mm2);
    return areas;
}

} // namespace lamella
