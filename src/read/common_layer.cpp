#include "lamella/core/error.hpp"

#include "read/common_layer_geometry.hpp"
#include "read/common_layer_header.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace lamella {

namespace {

/// Heights are tops of layers, and an empty layer before the first one tells where that begins. Exports exist
/// whose first layer lies on the bottom of the part and has contours: there heights are bottoms.
void make_layers(std::vector<RawLayer>& raw, const CommonLayerHeader& header, std::uint64_t bytes,
                 LayerFile& file, ReadLimits& limits) {
    sort_by_height(raw, file.warnings);
    if (raw.empty())
        return;
    const std::size_t n = raw.size();
    const bool has_zero_layer = raw.front().ends.empty() && raw.front().hatch_ends.empty() && n > 1;
    const double lowest = header.dimension ? (*header.dimension)[2] : 0.0;
    // A single layer below the bottom of the part has no thickness that could be told.
    const double first_step = n > 1 ? raw[1].z - raw[0].z : std::max(0.0, raw[0].z - lowest);
    const bool heights_are_bottoms = !has_zero_layer && n > 1 && raw.front().z <= lowest;
    if (heights_are_bottoms)
        file.warnings.push_back(
            fmt::format("the first layer, at the bottom of the part (z = {} mm), has contours; heights "
                        "are taken for the bottoms of layers",
                        raw.front().z));
    const auto layers = std::span(raw).subspan(has_zero_layer ? 1 : 0);
    check_part_planes(file, layers.size(), bytes);
    if (heights_are_bottoms)
        add_layers_by_bottoms(file, layers, raw[n - 1].z + (raw[n - 1].z - raw[n - 2].z), limits);
    else
        add_layers_by_tops(file, layers, raw[0].z - (has_zero_layer ? 0 : first_step), limits);
}

} // namespace

bool is_common_layer(std::string_view bytes) {
    constexpr std::size_t longest_preface = 1U << 16; // comments before the header
    const std::size_t at = bytes.substr(0, longest_preface).find(common_layer_start);
    return at != std::string_view::npos;
}

LayerFile read_common_layer(std::string_view bytes, const std::string& name, ReadLimits& limits,
                            const Execution& execution) {
    return read_common_layer(bytes, name, labelled_exposure, limits, execution);
}

LayerFile read_common_layer(std::string_view bytes, const std::string& name,
                            const ExposureOfLabel& exposure_of, ReadLimits& limits,
                            const Execution& execution) {
    const CommonLayerHeader header = read_common_layer_header(bytes, name);
    LayerFile file{.path = name, .format = header.binary ? "cli" : "cli-ascii", .units_mm = header.units_mm};
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
    make_layers(geometry.layers(), header, bytes.size(), file, limits);
    return file;
}

} // namespace lamella
