// Measures how much two other designs of the cut graph could gain on meshes whose triangles cross few planes.
// The preparation that each of them needs is done before and not counted, so the figures are upper bounds of
// the gain:
//
// - indices: the ends of edges are indices of welded vertices instead of coordinates. Welding is not counted,
// except in
//   the row "weld, indices".
// - blocks: the planes are sliced in blocks whose triangles and nodes stay in the second-level cache. Sorting
// the
//   triangles by blocks is not counted.
//
// Each measurement has its own process and slices twice; the second time counts. Processor seconds are the
// minimum of all rounds. The layers are the same in all designs.

#include "experiment.hpp"
#include "parts.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::bench {

namespace {

/// The planes of a block, and the triangles that they may cut.
struct Block {
    Plan plan;
    TriangleSoup triangles;
};

/// Divides the plan into blocks of about equally many triangles. Triangles that planes of several blocks may
/// cut are in each of these.
std::vector<Block> blocks_of(const TriangleSoup& soup, const Plan& plan, std::size_t count) {
    std::vector<double> z;
    for (const PlannedLayer& layer : plan.layers)
        z.push_back(layer.z);
    const auto plane_from = [&](double height) {
        return static_cast<std::size_t>(std::lower_bound(z.begin(), z.end(), height) - z.begin());
    };
    std::vector<std::uint64_t> begins(z.size() + 1); // triangles that begin at the plane
    std::vector<std::pair<std::size_t, std::size_t>> spans;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const Triangle3f t = soup.stored(i);
        const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
        // One more plane at each end, for the rule of planes through vertices.
        const std::size_t first = plane_from(low);
        spans.emplace_back(first > 0 ? first - 1 : 0, std::min(plane_from(high) + 1, z.size()));
        ++begins[spans.back().first];
    }
    std::vector<std::size_t> limits{0};
    std::uint64_t sum = 0;
    for (std::size_t plane = 0; plane < z.size(); ++plane) {
        sum += begins[plane];
        if (sum * count >= soup.size() * limits.size() && limits.size() < count && plane + 1 < z.size())
            limits.push_back(plane + 1);
    }
    limits.push_back(z.size());
    std::vector<std::vector<Triangle3f>> triangles(limits.size() - 1);
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const auto [first, last] = spans[i];
        for (std::size_t b = 0; b + 1 < limits.size(); ++b)
            if (first < limits[b + 1] && limits[b] < last)
                triangles[b].push_back(soup.stored(i));
    }
    std::vector<Block> blocks;
    for (std::size_t b = 0; b + 1 < limits.size(); ++b) {
        Plan planes;
        planes.layers.assign(plan.layers.begin() + static_cast<std::ptrdiff_t>(limits[b]),
                             plan.layers.begin() + static_cast<std::ptrdiff_t>(limits[b + 1]));
        blocks.push_back({std::move(planes), TriangleSoup(std::move(triangles[b]))});
    }
    return blocks;
}

struct Result {
    Cost cost;
    std::uint64_t hash;
    std::uint64_t triangles;
};

/// Slices blocks one after the other, twice, and counts the second time. `to_weld` becomes the mesh of the
/// only block.
Result slice_blocks(std::vector<std::pair<Mesh, Plan>> blocks, const TriangleSoup* to_weld) {
    Result result{};
    const LayerSink sink{[&](Layer&& layer) -> Commit {
        return [&result, hash = content_hash(layer)] {
            result.hash = result.hash * 0x9E3779B97F4A7C15 + hash;
        };
    }};
    for (int i = 0; i < 2; ++i) {
        result.hash = result.triangles = 0;
        result.cost = cost_of([&] {
            if (to_weld != nullptr)
                blocks.front().first = Mesh(weld(*to_weld, {.threads = 1}));
            for (const auto& [mesh, plan] : blocks) {
                result.triangles += mesh.size();
                slice_to(sink, mesh, plan, {.execution = {.threads = 1}});
            }
        });
    }
    return result;
}

Result measure_design(const Part& part, const std::string& design) {
    return measure_in_child<Result>([&] {
               const OpenedPart opened = open_part(part, {.threads = 1});
               const TriangleSoup& soup = *opened.mesh.soup();
               std::vector<std::pair<Mesh, Plan>> blocks;
               const bool welds = design == "weld, indices";
               if (design == "today" || welds) {
                   blocks.emplace_back(opened.mesh, opened.plan);
               } else if (design == "indices") {
                   blocks.emplace_back(Mesh(weld(soup)), opened.plan);
               } else {
                   for (Block& block : blocks_of(soup, opened.plan, std::stoul(design)))
                       blocks.emplace_back(Mesh(std::move(block.triangles)), std::move(block.plan));
               }
               return slice_blocks(std::move(blocks), welds ? &soup : nullptr);
           })
        .result;
}

int run(const Options& options) {
    std::vector<Part> parts = chosen_parts(options);
    parts.push_back(make_part("head", 0.1, [] { return make_head(); }));
    std::vector<std::string> designs{"today", "indices", "weld, indices"};
    for (const std::string& count : options.list("--blocks"))
        designs.push_back(count);

    std::cout << machine() << '\n';
    Table table({"part", "design", "triangles", "seconds", "of today"});
    bool right = true;
    for (const Part& part : parts) {
        std::vector<std::vector<Result>> results(designs.size());
        for (int round = 0; round < options.rounds(); ++round)
            for (std::size_t i = 0; i < designs.size(); ++i)
                results[i].push_back(measure_design(part, designs[i]));
        double of_today = 0;
        for (std::size_t i = 0; i < designs.size(); ++i) {
            std::vector<Cost> costs;
            for (const Result& result : results[i]) {
                right = right && result.hash == results[0][0].hash;
                costs.push_back(result.cost);
            }
            const double seconds = least(costs).cpu_s;
            if (i == 0)
                of_today = seconds;
            const bool blocks = i >= 3;
            table.add({part.name, blocks ? designs[i] + " blocks" : designs[i],
                       fmt::format("{}", results[i].front().triangles), fmt::format("{:.4f}", seconds),
                       fmt::format("{:.2f}", seconds / of_today)});
        }
    }
    std::cout << table.text();
    if (!right)
        std::cout << "WRONG: the layers differ\n";
    return right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::run(
        {argc, argv, "light_meshes [--parts rook,lattice] [--blocks 4,16,64] [--rounds 7]"});
}
