#include "pipeline/plane_scan.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/stack_hash.hpp"

#include "core/naming.hpp"
#include "scan/vector_bytes.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Returns the layers of one part on several planes.
std::vector<ScanLayer> layers_of(std::size_t part, const std::vector<std::span<const ScanLayer>>& planes) {
    std::vector<ScanLayer> layers;
    layers.reserve(planes.size());
    for (const std::span<const ScanLayer>& plane : planes)
        layers.push_back(plane[part]);
    return layers;
}

} // namespace

std::vector<Exposure> plane_exposures(const std::vector<bool>& supports, const ScanStrategy& strategy) {
    std::vector<Exposure> all;
    if (std::find(supports.begin(), supports.end(), false) != supports.end())
        all = exposures(strategy, {});
    if (std::find(supports.begin(), supports.end(), true) != supports.end())
        for (Exposure& exposure : support_exposures(strategy, {}))
            all.push_back(std::move(exposure));
    return all;
}

PlaneVectors scan_plane(const PlaneLayers& plane, const std::vector<bool>& supports,
                        std::span<const std::string> names, const ScanStrategy& strategy,
                        std::vector<InsetCache>& memories, const LayerLimits& limits) {
    assert(supports.size() == plane.parts.size() && memories.size() == plane.parts.size());
    assert(names.size() == plane.parts.size());
    const std::vector<Exposure> each = plane_exposures(supports, strategy);
    const auto of_supports = static_cast<std::size_t>(
        std::find_if(each.begin(), each.end(),
                     [](const Exposure& exposure) { return exposure.region == ScanRegion::support; }) -
        each.begin());
    PlaneVectors vectors;
    vectors.figures.resize(each.size());
    LayerLimits left = limits;
    std::optional<Point2> beam;
    std::vector<std::uint64_t> hashes;
    for (std::size_t part = 0; part < plane.parts.size(); ++part) {
        InsetCache* const memory = &memories[part];
        std::vector<double> unreached;
        std::vector<Layer> scanned = naming(names[part], [&] {
            return supports[part] ? scan_support(plane.parts[part], strategy, memory, &unreached, left)
                                  : scan(plane.parts[part], layers_of(part, plane.below),
                                         layers_of(part, plane.above), strategy, memory, &unreached, left);
        });
        const double sum = std::accumulate(unreached.begin(), unreached.end(), 0.0);
        vectors.unreached_mm2.push_back(sum > strategy.accepted_mm2 ? sum : 0);
        vectors.inverted.push_back(plane.parts[part].inverted());
        const std::size_t first = supports[part] ? of_supports : 0;
        assert(scanned.size() == (supports[part] ? each.size() : of_supports) - first);
        for (std::size_t i = 0; i < scanned.size(); ++i) {
            vectors.figures[first + i] += measure_vectors(scanned[i], each[first + i].parameters, beam);
            vectors.figures[first + i].unreached_mm2 += unreached[i];
            hashes.push_back(content_hash(scanned[i]));
            left = left.without(vector_bytes(scanned[i]));
            vectors.layers.push_back(std::move(scanned[i]));
        }
    }
    vectors.hash = stack_hash(hashes);
    return vectors;
}

} // namespace lamella
