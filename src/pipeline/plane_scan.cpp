#include "pipeline/plane_scan.hpp"

#include <cassert>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace lamella {

namespace {

/// The layers of one part on several planes.
std::vector<Layer> layers_of(std::size_t part, const std::vector<std::span<const Layer>>& planes) {
    std::vector<Layer> layers;
    layers.reserve(planes.size());
    for (const std::span<const Layer>& plane : planes)
        layers.push_back(plane[part]);
    return layers;
}

} // namespace

PlaneVectors scan_plane(const PlaneLayers& plane, const ScanStrategy& strategy) {
    const std::vector<Exposure> each = exposures(strategy, {});
    PlaneVectors vectors;
    vectors.figures.resize(each.size());
    std::optional<Point2> beam;
    for (std::size_t part = 0; part < plane.parts.size(); ++part) {
        std::vector<Layer> scanned =
            scan(plane.parts[part], layers_of(part, plane.below), layers_of(part, plane.above), strategy);
        assert(scanned.size() == each.size());
        for (std::size_t i = 0; i < each.size(); ++i) {
            vectors.figures[i] += measure_vectors(scanned[i], each[i].parameters, beam);
            vectors.layers.push_back(std::move(scanned[i]));
        }
    }
    return vectors;
}

} // namespace lamella
