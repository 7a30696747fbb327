#include "lamella/pipeline/scan_layers.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "core/counted.hpp"
#include "core/stopwatch.hpp"
#include "pipeline/plane_scan.hpp"
#include "write/ordered_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>

namespace lamella {

void UnreachedMaterial::add(double unreached_mm2, double z) noexcept {
    area_mm2 += unreached_mm2;
    if (unreached_mm2 > 0)
        AffectedLayers::add(z);
}

std::string UnreachedMaterial::text() const {
    return fmt::format("{:.4g} mm2 of material on {}, the lowest at z = {:.6g} mm, are reached by no vector: "
                       "it is too narrow for "
                       "contours, for lines of hatches or for lines of thin walls. More contours or smaller "
                       "values of beam_offset, "
                       "border, shortest or thinnest reach more; accepted_mm2 of the strategy says how much "
                       "of a layer may be "
                       "left",
                       area_mm2, counted(layers, "layer"), first_z);
}

LayerFileInfo with_exposures(const LayerFileInfo& info, const ScanStrategy& strategy) {
    LayerFileInfo exposed = info;
    exposed.parts.clear();
    for (const PartInfo& part : info.parts)
        for (const Exposure& exposure :
             part.support ? support_exposures(strategy, part.label) : exposures(strategy, part.label))
            exposed.parts.push_back({exposure.label(), part.box, exposure, part.support});
    return exposed;
}

namespace {

using StackedPlanes = std::vector<std::vector<ScanLayer>>; // of all parts

StackedPlanes stacked(std::span<const LayerStack> parts, const Rounding& rounding) {
    StackedPlanes planes(parts.empty() ? 0 : parts.front().size());
    for (const LayerStack& part : parts)
        for (std::size_t i = 0; i < part.size(); ++i) {
            ScanLayer& layer = planes[i].emplace_back(part[i], rounding);
            if (i > 0)
                layer.share_points(planes[i - 1][planes[i].size() - 1]);
        }
    return planes;
}

/// Returns a plane with the neighbours that a strategy needs.
PlaneLayers with_its_neighbours(const StackedPlanes& planes, std::size_t i, const ScanStrategy& strategy) {
    PlaneLayers found{.parts = planes[i]};
    for (std::size_t k = 1; k <= std::min<std::size_t>(strategy.downskin.layers, i); ++k)
        found.below.emplace_back(planes[i - k]);
    for (std::size_t k = 1; k <= std::min<std::size_t>(strategy.upskin.layers, planes.size() - 1 - i); ++k)
        found.above.emplace_back(planes[i + k]);
    return found;
}

} // namespace

ScanResult scan_layers(const std::string& path, const LayerFormat& format, std::span<const LayerStack> parts,
                       const Rounding& rounding, const LayerFileInfo& info, const ScanStrategy& strategy,
                       const LayerWriteOptions& options, const Execution& execution) {
    check_strategy(strategy);
    check_same_planes(parts, info);
    const StackedPlanes planes = stacked(parts, rounding);
    ScanResult result;
    std::vector<bool> supports;
    std::vector<std::string> names;
    for (const PartInfo& part : info.parts) {
        supports.push_back(part.support);
        names.push_back(info.parts.size() > 1 ? fmt::format("part \"{}\"", excerpt(part.label)) : "");
    }
    for (Exposure& exposure : plane_exposures(supports, strategy))
        result.exposures.push_back({std::move(exposure), {}});
    result.layers.resize(planes.size());
    std::vector<double> unreached(planes.size());
    result.hashes.resize(planes.size());
    std::vector<ScanMemory> memories(supports.size());
    std::atomic<std::uint64_t> nanoseconds{0};
    const std::unique_ptr<LayerWriter> writer =
        open_layer_writer(path, format, with_exposures(info, strategy), options);
    const auto vectors_of = [&](std::size_t i) {
        const Stopwatch scanning;
        PlaneVectors vectors =
            scan_plane(with_its_neighbours(planes, i, strategy), supports, names, strategy, memories);
        nanoseconds.fetch_add(static_cast<std::uint64_t>(1e9 * scanning.seconds()),
                              std::memory_order_relaxed);
        result.layers[i] = std::move(vectors.figures);
        unreached[i] = std::accumulate(vectors.unreached_mm2.begin(), vectors.unreached_mm2.end(), 0.0);
        result.hashes[i] = vectors.hash;
        return std::move(vectors.layers);
    };
    write_planes(*writer, planes.size(), vectors_of, execution);
    for (std::size_t i = 0; i < planes.size(); ++i)
        result.unreached.add(unreached[i], planes[i].front().layer().z);
    if (options.strict && result.unreached.layers > 0)
        throw Error(ErrorKind::defect, fmt::format("{}: {}", path, result.unreached.text()));
    writer->finish();
    for (const std::vector<ScanFigures>& layer : result.layers)
        for (std::size_t i = 0; i < layer.size(); ++i)
            result.exposures[i].figures += layer[i];
    result.scan_seconds = 1e-9 * static_cast<double>(nanoseconds);
    result.bytes = writer->bytes();
    result.warnings = writer->warnings();
    return result;
}

} // namespace lamella
