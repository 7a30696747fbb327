#include "lamella/pipeline/scan_layers.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "core/executor.hpp"
#include "core/stopwatch.hpp"
#include "pipeline/job_output.hpp"
#include "pipeline/layer_processor.hpp"

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
            exposed.parts.push_back(
                {.label = exposure.label(), .box = part.box, .exposure = exposure, .support = part.support});
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

FileResult scan_layers(const std::string& path, const LayerFormat& format, const PlaneSource& source,
                       const ScanStrategy& strategy, const LayerWriteOptions& options,
                       const Execution& execution, std::uint64_t max_memory) {
    const Stopwatch total;
    check_strategy(strategy);
    const LayerFileInfo info = info_of(source);
    FileResult result;
    result.threads = thread_count(source.for_planes(execution));
    const OutputFiles files{.path = path, .format = &format, .write = options};
    LayerJob job{.names = names_of(info, source.path),
                 .rounding = source.rounding,
                 .written = files.rounding(),
                 .of_mesh = false,
                 .scan = strategy,
                 .statistics = true,
                 .limits = layer_limits(execution, max_memory, result.threads)};
    for (const PartInfo& part : info.parts) {
        job.supports.push_back(part.support);
        job.objects.push_back(static_cast<std::uint32_t>(job.objects.size()));
        result.parts.push_back({.label = part.label, .box = part.box});
    }
    std::vector<PlannedLayer> planes;
    for (const Layer& layer : source.planes)
        planes.push_back({layer.index, layer.z, layer.bottom, layer.top});
    const PlaneRange all{0, static_cast<std::uint32_t>(planes.size())};
    JobOutput output(files, with_exposures(info, strategy));
    LayerProcessor processor(std::move(job), planes, all, all, output);
    const PlaneSink process = [&](std::size_t plane, const ScanVectors& layers) {
        return processor.prepare(static_cast<std::uint32_t>(plane), layers.polylines);
    };
    source.run(Stage::write, process, execution);
    processor.set_times(result.seconds);
    processor.totals().store_in(result);
    if (const Finding* found = result.findings.first(Severity::warning); options.strict && found != nullptr)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {}", source.path.empty() ? path : source.path, found->text()));
    output.finish_file(result);
    result.seconds.total = total.seconds();
    return result;
}

} // namespace lamella
