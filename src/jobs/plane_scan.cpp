#include "jobs/plane_scan.hpp"

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
                        const Rounding& written, std::vector<InsetCache>& caches, const LayerLimits& limits) {
    assert(supports.size() == plane.parts.size() && caches.size() == plane.parts.size());
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
    for (std::size_t part = 0; part < plane.parts.size(); ++part) {
        const ScanOptions options{.cache = &caches[part], .limits = left, .written = written};
        ScannedLayer scanned = naming(names[part], [&] {
            return supports[part] ? scan_support(plane.parts[part], strategy, options)
                                  : scan(plane.parts[part], layers_of(part, plane.below),
                                         layers_of(part, plane.above), strategy, options);
        });
        const double sum = std::accumulate(scanned.unreached_mm2.begin(), scanned.unreached_mm2.end(), 0.0);
        vectors.unreached_mm2.push_back(sum > strategy.accepted_mm2 ? sum : 0);
        vectors.inverted.push_back(plane.parts[part].inverted());
        const std::size_t first = supports[part] ? of_supports : 0;
        assert(scanned.vectors.parts() == (supports[part] ? each.size() : of_supports) - first);
        for (std::size_t i = 0; i < scanned.vectors.parts(); ++i) {
            const Layer& polylines = scanned.vectors.polylines[i];
            const PointArray& hatches = scanned.vectors.hatches[i];
            ScanFigures& figures = vectors.figures[first + i];
            const MeasuredVectors measured =
                measure_vectors(polylines, hatches.span(), each[first + i].parameters, beam);
            beam = measured.beam;
            figures += measured.figures;
            figures.unreached_mm2 += scanned.unreached_mm2[i];
            left = left.without(vector_bytes(polylines, hatches));
        }
        vectors.vectors.append(std::move(scanned.vectors));
    }
    vectors.hash = content_hash(vectors.vectors);
    return vectors;
}

} // namespace lamella
