#include "lamella/pipeline/scan_layers.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "core/counted.hpp"
#include "core/executor.hpp"
#include "core/naming.hpp"
#include "core/ordered_stage.hpp"
#include "core/stopwatch.hpp"
#include "pipeline/layer_window.hpp"
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
                       "it is too narrow for contours, for lines of hatches or for lines of thin walls. More "
                       "contours or smaller values of beam_offset, border, shortest or thinnest reach more; "
                       "accepted_mm2 of the strategy says how much of a layer may be left",
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

/// Returns the names of the parts of a file for error messages.
std::vector<std::string> names_of(const LayerFileInfo& info, const std::string& file) {
    std::vector<std::string> names;
    for (const PartInfo& part : info.parts) {
        const std::string label =
            info.parts.size() > 1 ? fmt::format("part \"{}\"", excerpt(part.label)) : "";
        names.push_back(fmt::format("{}{}{}", file, file.empty() || label.empty() ? "" : ", ", label));
    }
    return names;
}

} // namespace

ScanResult scan_layers(const std::string& path, const LayerFormat& format, std::span<const LayerStack> parts,
                       const Rounding& rounding, const LayerFileInfo& info, const ScanStrategy& strategy,
                       const LayerWriteOptions& options, const Execution& execution, std::uint64_t max_memory,
                       const std::string& name) {
    check_strategy(strategy);
    check_same_planes(parts, info);
    const auto planes = static_cast<std::uint32_t>(parts.empty() ? 0 : parts.front().size());
    ScanResult result;
    std::vector<bool> supports;
    for (const PartInfo& part : info.parts)
        supports.push_back(part.support);
    const std::vector<std::string> names = names_of(info, name);
    for (Exposure& exposure : plane_exposures(supports, strategy))
        result.exposures.push_back({std::move(exposure), {}});
    result.layers.resize(planes);
    std::vector<double> unreached(planes);
    result.hashes.resize(planes);
    std::vector<InsetCache> memories(supports.size());
    std::atomic<std::uint64_t> nanoseconds{0};
    const std::unique_ptr<LayerWriter> writer =
        open_layer_writer(path, format, with_exposures(info, strategy), options);

    Executor executor(execution);
    const unsigned workers = executor.workers();
    const LayerLimits limits = layer_limits(execution, max_memory, workers);
    const auto write = [&](const PlaneLayers& plane) {
        const Stopwatch scanning;
        PlaneVectors vectors = scan_plane(plane, supports, names, strategy, memories, limits);
        nanoseconds.fetch_add(static_cast<std::uint64_t>(1e9 * scanning.seconds()),
                              std::memory_order_relaxed);
        result.layers[plane.plane] = std::move(vectors.figures);
        unreached[plane.plane] =
            std::accumulate(vectors.unreached_mm2.begin(), vectors.unreached_mm2.end(), 0.0);
        result.hashes[plane.plane] = vectors.hash;
        return writer->prepare(vectors.vectors);
    };
    LayerWindow window(
        {0, planes}, {0, planes}, strategy.downskin.layers, strategy.upskin.layers,
        [&](std::size_t part, const Layer& layer) {
            return naming(names[part], [&] { return ScanLayer(layer, rounding, limits); });
        },
        write);
    ProgressMeter progress(execution, Stage::write, planes);
    run_in_order(executor, progress, planes, [&](std::uint64_t plane) {
        std::vector<Layer> layers;
        for (const LayerStack& part : parts)
            layers.push_back(part[plane]);
        return window(static_cast<std::uint32_t>(plane), layers);
    });
    progress.finish();

    for (std::uint32_t i = 0; i < planes; ++i)
        result.unreached.add(unreached[i], parts.front()[i].z);
    if (options.strict && result.unreached.layers > 0)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {}", name.empty() ? path : name, result.unreached.text()));
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
