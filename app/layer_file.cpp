#include "layer_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/pipeline/layer_files.hpp"
#include "lamella/pipeline/layer_warnings.hpp"
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

/// Warns like warn_about of rings that bound no material.
void warn_about_inverted(const LayerFile& file, const InvertedLayers& inverted, bool strict,
                         Messages& messages) {
    if (inverted.rings > 0)
        warn_about(file, {inverted.text_of_file(file.planes().size())}, strict, messages);
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
        warn_about_inverted(file, layer_doubts(file, InversionSearch::quick, execution, max_memory).inverted,
                            strict, messages);
    LayerDoubtSearch search(file.planes().size(), file.rounding, InversionSearch::quick, execution,
                            max_memory);
    lamella::write_planes(
        writer, file.planes().size(),
        [&](std::size_t i) {
            ScanVectors plane = file.plane(i);
            if (search_rings && !strict)
                search.look_at(i, file, plane);
            return plane;
        },
        file.for_planes(execution));
    warn_about_inverted(file, search.doubts().inverted, strict, messages);
}

LayersKept layers_kept(const LayerSteps& steps) {
    return steps.any() ? LayersKept::if_ample : LayersKept::if_faster;
}

StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory) {
    SteppedFile stepped = lamella::take_steps(steps, std::move(file), execution, max_memory);
    file = std::move(stepped.file);
    warn_about_inverted(file, stepped.inverted, strict, messages);
    StepChanges changes{.planes = std::move(stepped.planes), .all = {}};
    for (const LayerChanges& plane : changes.planes)
        changes.all += plane;
    if (stepped.hatch_lines_dropped > 0)
        warn_about(file,
                   {fmt::format("{} left out: the contours that they fill were changed",
                                counted(stepped.hatch_lines_dropped, "hatch line"))},
                   strict, messages);
    if (const std::string nothing = nothing_left(changes.planes.size(), stepped.contours, changes.all);
        !nothing.empty())
        warn_about(file, {nothing}, strict, messages);
    return changes;
}

} // namespace lamella::app
