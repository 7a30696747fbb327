#include "layer_file.hpp"

#include "lamella/core/error.hpp"

#include "messages.hpp"
#include "numbers.hpp"

#include <fmt/format.h>

#include <utility>

namespace lamella::app {
namespace {

/// Never empty.
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

LayerFileInfo info_of(const LayerFile& file) {
    const LayerStack& layers = file.parts.front().layers;
    if (layers.empty())
        throw Error(ErrorKind::input, fmt::format("{}: holds no layers", file.path));
    LayerFileInfo info{
        .box = {}, .layers = layers.size(), .bottom = layers.front().bottom, .parts = {}, .rule = file.rule};
    for (const LayerPart& part : file.parts)
        info.parts.push_back({part.label.empty() ? PartInfo{}.label : part.label, part_box(part.layers),
                              part.exposure, part.support});
    info.box = box_of(info, layers);
    return info;
}

void check_warnings(const LayerFile& file) {
    if (!file.warnings.empty())
        throw Error(ErrorKind::defect, fmt::format("{}: {}", file.path, file.warnings.front()));
}

void check_no_vectors(const LayerFile& file, const LayerSteps& steps) {
    for (const LayerPart& part : file.parts)
        if (part.exposure && steps.any())
            throw Error(ErrorKind::usage,
                        fmt::format("{}: holds scan vectors ({}), and --fill, --offset, --largest-only, "
                                    "--min-area and --simplify are for contours: take these steps before "
                                    "lamella scan",
                                    file.path, one_line(part.label)));
}

std::vector<LayerChanges> take_steps(const LayerSteps& steps, LayerFile& file, const Execution& execution) {
    std::vector<LayerStack> parts;
    for (LayerPart& part : file.parts)
        parts.push_back(std::move(part.layers));
    std::vector<LayerChanges> planes;
    parts = take_steps(steps, std::move(parts), planes, execution);
    for (std::size_t i = 0; i < parts.size(); ++i)
        file.parts[i].layers = std::move(parts[i]);
    return planes;
}

std::string lost_hatches(const LayerFile& file, const LayerChanges& changes) {
    if (changes.hatches_dropped == 0)
        return "";
    return fmt::format("{}: {} left out: the contours that they fill were changed", file.path,
                       counted(changes.hatches_dropped, "hatch line"));
}

} // namespace lamella::app
