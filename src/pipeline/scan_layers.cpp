#include "lamella/pipeline/scan_layers.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "core/executor.hpp"
#include "core/ordered_stage.hpp"
#include "core/stopwatch.hpp"
#include "pipeline/job_output.hpp"
#include "pipeline/layer_processor.hpp"
#include "write/ordered_writer.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

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

/// Scans planes. `heights` has a layer of each plane; `layers_on(plane)` returns the layers of all parts.
template <class LayersOn>
FileResult scan_planes(const std::string& path, const LayerFormat& format, std::span<const Layer> heights,
                       const LayersOn& layers_on, const Rounding& rounding, const LayerFileInfo& info,
                       const ScanStrategy& strategy, const LayerWriteOptions& options,
                       const Execution& execution, std::uint64_t max_memory, const std::string& name) {
    const Stopwatch total;
    check_strategy(strategy);
    Executor executor(execution);
    FileResult result;
    result.threads = executor.workers();
    const OutputFiles files{.path = path, .format = &format, .write = options};
    LayerJob job{.names = names_of(info, name),
                 .rounding = rounding,
                 .written = files.rounding(),
                 .of_mesh = false,
                 .scan = strategy,
                 .statistics = true,
                 .limits = layer_limits(execution, max_memory, executor.workers())};
    for (const PartInfo& part : info.parts) {
        job.supports.push_back(part.support);
        job.objects.push_back(static_cast<std::uint32_t>(job.objects.size()));
        result.parts.push_back({.label = part.label, .box = part.box});
    }
    std::vector<PlannedLayer> planes;
    for (const Layer& layer : heights)
        planes.push_back({layer.index, layer.z, layer.bottom, layer.top});
    const PlaneRange all{0, static_cast<std::uint32_t>(planes.size())};
    JobOutput output(files, with_exposures(info, strategy), all);
    LayerProcessor processor(std::move(job), planes, all, all, output);

    ProgressMeter progress(execution, Stage::write, all.size());
    run_in_order(executor, progress, all.size(), [&](std::uint64_t plane) {
        return processor.prepare(static_cast<std::uint32_t>(plane), layers_on(plane));
    });
    progress.finish();

    processor.set_times(result.seconds);
    processor.totals().store_in(result);
    if (const Finding* found = result.findings.first_warning(); options.strict && found != nullptr)
        throw Error(ErrorKind::defect, fmt::format("{}: {}", name.empty() ? path : name, found->text()));
    output.finish_file(result);
    result.seconds.total = total.seconds();
    return result;
}

} // namespace

FileResult scan_layers(const std::string& path, const LayerFormat& format, std::span<const LayerStack> parts,
                       const Rounding& rounding, const LayerFileInfo& info, const ScanStrategy& strategy,
                       const LayerWriteOptions& options, const Execution& execution, std::uint64_t max_memory,
                       const std::string& name) {
    check_same_planes(parts, info);
    const auto layers_on = [&](std::size_t plane) {
        std::vector<Layer> layers;
        for (const LayerStack& part : parts)
            layers.push_back(part[plane]);
        return layers;
    };
    return scan_planes(path, format, parts.empty() ? std::span<const Layer>() : parts.front(), layers_on,
                       rounding, info, strategy, options, execution, max_memory, name);
}

FileResult scan_layers(const std::string& path, const LayerFormat& format, const LayerFile& file,
                       const LayerFileInfo& info, const ScanStrategy& strategy,
                       const LayerWriteOptions& options, const Execution& execution,
                       std::uint64_t max_memory) {
    return scan_planes(
        path, format, file.planes(), [&](std::size_t plane) { return file.plane(plane).polylines; },
        file.rounding, info, strategy, options, file.for_planes(execution), max_memory, file.path);
}

} // namespace lamella
