#include "layer_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/pipeline/layer_files.hpp"
#include "lamella/pipeline/layer_findings.hpp"
#include "lamella/polygon/inverted_rings.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace lamella::app {
namespace {

/// Returns the box, which is never empty.
Box3 box_of(const LayerFileInfo& info, const LayerStack& layers) {
    Box3 box;
    for (const PartInfo& part : info.parts)
        box.add(part.box);
    if (box.empty())
        box.add(Point3{});
    box.min.z = layers.front().bottom;
    box.max.z = layers.back().top;
    return box;
}

} // namespace

LayerFileInfo info_of(const LayerFile& file, const Execution& execution) {
    const LayerStack& layers = file.planes();
    if (layers.empty())
        throw Error(ErrorKind::input, fmt::format("{}: holds no layers", file.path));
    LayerFileInfo info{
        .box = {}, .layers = layers.size(), .bottom = layers.front().bottom, .parts = {}, .rule = file.rule};
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        const LayerPart& part = file.parts[i];
        info.parts.push_back(
            {part.label.empty() ? PartInfo{}.label : part.label,
             file.stream ? file.stream->boxes[i] : part_box(part.layers, part.hatches, execution),
             part.exposure, part.support});
    }
    info.box = box_of(info, layers);
    return info;
}

void warn_about(const LayerFile& file, const std::vector<std::string>& warnings, bool strict,
                Messages& messages) {
    if (strict && !warnings.empty())
        throw Error(ErrorKind::defect, fmt::format("{}: {}", file.path, warnings.front()));
    for (const std::string& warning : warnings)
        messages.warn(fmt::format("{}: {}", input_name(file.path), warning));
}

void write_planes(LayerWriter& writer, const LayerFile& file, bool search_rings, bool strict,
                  Messages& messages, const Execution& execution, std::uint64_t max_memory) {
    if (search_rings && strict) // before standard output receives anything
        warn_about(
            file, layer_findings(file, LayerUse::kept, InversionSearch::quick, execution, max_memory).texts(),
            strict, messages);
    LayerFindingSearch search(file.planes().size(), LayerUse::kept, file.rounding, InversionSearch::quick,
                              execution, max_memory);
    lamella::write_planes(
        writer, file.planes().size(),
        [&](std::size_t i) {
            ScanVectors plane = file.plane(i);
            if (search_rings && !strict)
                search.look_at(i, file, plane);
            return plane;
        },
        file.for_planes(execution));
    warn_about(file, search.findings().texts(), strict, messages);
}

LayersKept layers_kept(const LayerSteps& steps) {
    return steps.any() ? LayersKept::if_ample : LayersKept::if_faster;
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
