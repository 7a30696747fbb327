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

/// Reports inverted rings. Steps drop them because they have no material, unless a fill rule defines the
/// material.
void warn_about_inverted(const LayerSteps& steps, const LayerFile& file, bool strict, Messages& messages,
                         const Execution& execution, std::uint64_t max_memory) {
    if (steps.fill != FillRule::none)
        return;
    std::vector<LayerStack> contours;
    for (const LayerPart& part : file.parts)
        if (!part.exposure)
            contours.push_back(part.layers);
    const InversionSearch search = steps.offset_mm != 0 ? InversionSearch::full : InversionSearch::quick;
    const InvertedLayers inverted =
        layer_doubts(contours, file.rounding, search, execution, max_memory).inverted;
    if (inverted.rings > 0)
        warn_about(file, {inverted.text_of_file(contours.front().size())}, strict, messages);
}

} // namespace

LayerFileInfo info_of(const LayerFile& file) {
    const LayerStack& layers = file.parts.front().layers;
    if (layers.empty())
        throw Error(ErrorKind::input, fmt::format("{}: holds no layers", file.path));
    LayerFileInfo info{
        .box = {}, .layers = layers.size(), .bottom = layers.front().bottom, .parts = {}, .rule = file.rule};
    for (const LayerPart& part : file.parts)
        info.parts.push_back({part.label.empty() ? PartInfo{}.label : part.label,
                              part_box(part.layers, part.hatches), part.exposure, part.support});
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

StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory) {
    for (const LayerPart& part : file.parts)
        if (part.exposure && steps.any())
            throw Error(ErrorKind::usage,
                        fmt::format("{}: holds scan vectors ({}), and --fill, --offset, --largest-only, "
                                    "--min-area and --simplify are for contours: take these steps before "
                                    "lamella scan",
                                    file.path, one_line(part.label)));
    warn_about_inverted(steps, file, strict, messages, execution, max_memory);
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
