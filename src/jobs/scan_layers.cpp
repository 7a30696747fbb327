#include "lamella/jobs/scan_layers.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "core/executor.hpp"
#include "core/stopwatch.hpp"
#include "jobs/job_output.hpp"
#include "jobs/layer_processor.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
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

/// Computes the scan vectors of all planes for an output whose coordinates have the rounding `written`.
FileResult scan_to(JobOutput& output, const LayerFileInfo& info, const Rounding& written,
                   const PlaneSource& source, const ScanStrategy& strategy, const Execution& execution,
                   std::uint64_t max_memory) {
    FileResult result;
    result.threads = thread_count(source.for_planes(execution));
    LayerJob job{.names = names_of(info, source.path),
                 .rounding = source.rounding,
                 .written = written,
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
    LayerProcessor processor(std::move(job), planes, all, all, output);
    const PlaneSink process = [&](std::size_t position, Plane plane) {
        return processor.prepare(static_cast<std::uint32_t>(position), std::move(plane));
    };
    source.run(Stage::write, process, execution);
    processor.set_times(result.seconds);
    processor.totals().store_in(result);
    return result;
}

/// Keeps planes in memory.
class PlaneKeeper final : public LayerWriter {
  public:
    explicit PlaneKeeper(std::vector<Plane>& planes) : planes_(planes) {}

    [[nodiscard]] Commit prepare(const Plane& plane) override {
        return [this, plane] {
            planes_.push_back(plane);
        };
    }
    void finish() override {}
    [[nodiscard]] std::uint64_t bytes() const noexcept override { return 0; }

  private:
    std::vector<Plane>& planes_;
};

} // namespace

FileResult scan_layers(const std::string& path, const LayerFormat& format, const PlaneSource& source,
                       const ScanStrategy& strategy, const LayerWriteOptions& options,
                       const Execution& execution, std::uint64_t max_memory) {
    const Stopwatch total;
    check_strategy(strategy);
    const LayerFileInfo info = info_of(source);
    const OutputFiles files{.path = path, .format = &format, .write = options};
    JobOutput output(files, with_exposures(info, strategy));
    FileResult result = scan_to(output, info, files.rounding(), source, strategy, execution, max_memory);
    if (const Finding* found = result.findings.first(Severity::warning); options.strict && found != nullptr)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {}", source.path.empty() ? path : source.path, found->text()));
    output.finish_file(result);
    result.seconds.total = total.seconds();
    return result;
}

ScannedLayers scan_layers(const PlaneSource& source, const ScanStrategy& strategy, const Execution& execution,
                          std::uint64_t max_memory) {
    const Stopwatch total;
    check_strategy(strategy);
    const LayerFileInfo info = info_of(source);
    const LayerFileInfo exposed = with_exposures(info, strategy);
    std::vector<Plane> planes;
    const OutputFiles none;
    JobOutput output(none, exposed, std::make_unique<PlaneKeeper>(planes));
    FileResult result = scan_to(output, info, {}, source, strategy, execution, max_memory);
    ScannedLayers scanned{source_of(std::move(planes), exposed.parts, source.path, execution), {}};
    scanned.vectors.rounding = source.rounding;
    scanned.vectors.rule = source.rule;
    scanned.figures = std::move(result);
    scanned.figures.seconds.total = total.seconds();
    return scanned;
}

} // namespace lamella
