#include "read/common_layer.hpp"

#include "lamella/core/error.hpp"

#include "read/common_layer_geometry.hpp"
#include "read/common_layer_header.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lamella {

bool is_common_layer(std::string_view bytes) {
    constexpr std::size_t longest_preface = 1U << 16; // comments before the header
    const std::size_t at = bytes.substr(0, longest_preface).find(common_layer_start);
    return at != std::string_view::npos;
}

CommonLayerContent read_common_layer_content(std::string_view bytes, const std::string& name,
                                             const ExposureOfLabel& exposure_of, ReadLimits& limits,
                                             const Execution& execution) {
    const CommonLayerHeader header = read_common_layer_header(bytes, name);
    CommonLayerContent content{
        .file = {.path = name, .format = header.binary ? "cli" : "cli-ascii", .units_mm = header.units_mm},
        .layers = {},
        .bytes = bytes.size()};
    LayerFile& file = content.file;
    CommonLayerGeometry geometry(header, name, limits);
    if (header.binary)
        read_binary_geometry(bytes, name, header, execution, geometry);
    else
        read_ascii_geometry(bytes, name, header, execution, geometry);
    const std::uint64_t found = geometry.layers().size();
    if (found == 0)
        throw Error(ErrorKind::input,
                    fmt::format("{}, byte {}: found no layer; a slice file must have at least one", name,
                                header.end));
    if (header.layers && *header.layers != found)
        file.warnings.push_back(
            fmt::format("the header announces {} layers; the file has {}", *header.layers, found));
    file.rounding = geometry.rounding(header.binary);
    geometry.say(file.warnings);
    geometry.number_parts(header, file);
    for (LayerPart& part : file.parts)
        part.exposure = exposure_of(part.label);
    content.layers = std::move(geometry.layers());
    sort_by_height(content.layers, file.warnings);
    content.lowest = header.dimension ? (*header.dimension)[2] : 0.0;
    const RawLayer& first = content.layers.front();
    content.on_bottom = first.drawn && (header.dimension ? first.z <= content.lowest : first.z == 0);
    return content;
}

std::vector<double> bottoms_of(std::span<const CommonLayerContent> files, double same, ReadLimits& limits) {
    std::vector<double> heights;
    for (const CommonLayerContent& content : files) {
        limits.make_room(heights, content.layers.size(), [&] { return std::string_view(content.file.path); });
        for (const RawLayer& raw : content.layers)
            heights.push_back(raw.z);
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(
        std::unique(heights.begin(), heights.end(), [&](double a, double b) { return b - a <= same; }),
        heights.end());
    const bool on_bottom = std::any_of(files.begin(), files.end(), [&](const CommonLayerContent& content) {
        return content.on_bottom && content.layers.front().z - heights.front() <= same;
    });
    if (!on_bottom || heights.size() == 1) // a single one has no thickness that could be told
        heights.clear();
    return heights;
}

LayerFile layers_of(CommonLayerContent content, std::span<const double> bottoms, ReadLimits& limits) {
    LayerFile& file = content.file;
    std::span<RawLayer> layers(content.layers);
    const std::size_t n = layers.size();
    const double first = layers.front().z;
    double bottom = first;
    if (!bottoms.empty()) {
        if (content.on_bottom)
            file.warnings.push_back(
                fmt::format("the first layer, at the bottom of the part (z = {} mm), has contours; heights "
                            "are taken for the bottoms of layers",
                            first));
        const double top = bottoms.back() + (bottoms.back() - bottoms[bottoms.size() - 2]);
        for (RawLayer& raw : layers) {
            const auto next = std::upper_bound(bottoms.begin(), bottoms.end(), raw.z);
            raw.z = next == bottoms.end() ? top : *next;
        }
    } else if (n > 1 && !layers.front().drawn) {
        layers = layers.subspan(1);
    } else {
        // A single layer below the bottom of the part has no thickness that could be told.
        bottom -= n > 1 ? layers[1].z - first : std::max(0.0, first - content.lowest);
    }
    check_part_planes(file, layers.size(), content.bytes);
    add_layers_by_tops(file, layers, bottom, limits);
    return std::move(file);
}

LayerFile read_common_layer(std::string_view bytes, const std::string& name, ReadLimits& limits,
                            const Execution& execution) {
    CommonLayerContent content = read_common_layer_content(bytes, name, labelled_exposure, limits, execution);
    const std::vector<double> bottoms = bottoms_of({&content, 1}, 0, limits);
    return layers_of(std::move(content), bottoms, limits);
}

} // namespace lamella
