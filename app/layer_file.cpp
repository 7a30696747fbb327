#include "layer_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/jobs/layer_files.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/polygon/inverted_rings.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace lamella::app {

void warn_about(const LayerFile& file, const std::vector<std::string>& warnings, bool strict,
                Messages& messages) {
    if (strict && !warnings.empty())
        throw Error(ErrorKind::defect, fmt::format("{}: {}", file.path, warnings.front()));
    for (const std::string& warning : warnings)
        messages.warn(fmt::format("{}: {}", input_name(file.path), warning));
}

void refuse_options_of_meshes(const LayerFile& file) {
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: holds layers, and these stay where they are; options of where a part stands and "
                    "how it is cut are for meshes",
                    file.path));
}

void write_planes(LayerWriter& writer, const LayerFile& file, bool search_rings, bool strict,
                  Messages& messages, const Execution& execution, std::uint64_t max_memory) {
    if (search_rings && strict) // before standard output receives anything
        warn_about(
            file, layer_findings(file, LayerUse::kept, InversionSearch::quick, execution, max_memory).texts(),
            strict, messages);
    LayerFindingSearch search(file.planes.size(), LayerUse::kept, file.rounding, InversionSearch::quick,
                              execution, max_memory);
    const PlaneSink write = [&](std::size_t i, const Plane& plane) {
        if (search_rings && !strict)
            search.look_at(i, file, plane);
        return writer.prepare(plane);
    };
    file.run(Stage::write, write, execution);
    warn_about(file, search.findings().texts(), strict, messages);
}

StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory) {
    SteppedFile stepped = lamella::take_steps(steps, std::move(file), execution, max_memory);
    file = std::move(stepped.file);
    warn_about(file, stepped.findings.texts(), strict, messages);
    StepChanges changes{.planes = std::move(stepped.planes), .all = {}};
    for (const LayerChanges& plane : changes.planes)
        changes.all += plane;
    return changes;
}

} // namespace lamella::app
