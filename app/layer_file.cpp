#include "layer_file.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
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
        execution);
    warn_about_inverted(file, search.doubts().inverted, strict, messages);
}

StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory) {
    for (const LayerPart& part : file.parts)
        if (part.exposure && steps.any())
            throw Error(ErrorKind::usage,
                        fmt::format("{}: holds scan vectors ({}), and --fill, --offset, --largest-only, "
                                    "--min-area and --simplify are for contours: take these steps before "
                                    "lamella scan",
                                    file.path, one_line(part.label)));
    // Steps drop inverted rings because they have no material, unless a fill rule defines the material.
    if (steps.fill == FillRule::none)
        warn_about_inverted(
            file,
            layer_doubts(file, steps.offset_mm != 0 ? InversionSearch::full : InversionSearch::quick,
                         execution, max_memory)
                .inverted,
            strict, messages);
    std::vector<LayerStack> parts;
    std::vector<std::string> names;
    for (LayerPart& part : file.parts) {
        parts.push_back(std::move(part.layers));
        names.push_back(file.parts.size() == 1
                            ? file.path
                            : fmt::format("{}, part \"{}\"", file.path, excerpt(part.label)));
    }
    const std::vector<LayerStack> before = parts; // shares their points
    ChangedStacks stepped = lamella::take_steps(
        steps, std::move(parts), {.execution = execution, .max_memory = max_memory, .names = names});
    parts = std::move(stepped.parts);
    StepChanges changes{.planes = std::move(stepped.planes), .all = {}};
    std::uint64_t contours = 0;
    std::uint64_t hatches_dropped = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        LayerPart& part = file.parts[i];
        for (std::size_t plane = 0; plane < parts[i].size(); ++plane) {
            contours += parts[i][plane].contours();
            if (!part.hatches_of(plane).empty() && !same_contours(before[i][plane], parts[i][plane])) {
                hatches_dropped += part.hatches[plane].size() / 2;
                part.hatches[plane] = {};
            }
        }
        part.layers = std::move(parts[i]);
    }
    for (const LayerChanges& plane : changes.planes)
        changes.all += plane;
    if (hatches_dropped > 0)
        warn_about(file,
                   {fmt::format("{} left out: the contours that they fill were changed",
                                counted(hatches_dropped, "hatch line"))},
                   strict, messages);
    if (const std::string nothing = nothing_left(changes.planes.size(), contours, changes.all);
        !nothing.empty())
        warn_about(file, {nothing}, strict, messages);
    return changes;
}

} // namespace lamella::app
