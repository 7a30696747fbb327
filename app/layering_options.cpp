#include "layering_options.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "z_list.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>

namespace lamella::app {

std::vector<HeightRange> parse_height_ranges(std::string_view text) {
    std::vector<HeightRange> ranges;
    for (const std::string_view one : list_items(text)) {
        const std::size_t equals = one.find('=');
        const std::size_t colon = one.find(':');
        if (equals == std::string_view::npos || colon == std::string_view::npos || colon > equals)
            throw Error(ErrorKind::usage,
                        fmt::format("\"{}\" is no range of heights; expected one such as 0:5=0.1,5:20=0.2",
                                    excerpt(one)));
        ranges.push_back({parse_number(one.substr(0, colon)),
                          parse_number(one.substr(colon + 1, equals - colon - 1)),
                          parse_positive(one.substr(equals + 1))});
    }
    if (ranges.empty())
        throw Error(ErrorKind::usage, "expected ranges such as 0:5=0.1,5:20=0.2");
    return ranges;
}

namespace {

/// Throws if two options define the heights of cuts, or if one option has no effect because of another.
void check_ways(const LayeringOptions& options) {
    struct Given {
        std::string_view name;
        bool given;
    };
    const Given layer_height{"--layer-height", options.layer_height.has_value()};
    const Given first_height{"--first-layer-height", options.first_layer_height.has_value()};
    const Given z_list{"--z-list", !options.z_list.empty()};
    const Given heights{"--heights", !options.heights.empty()};
    const Given adaptive{"--adaptive", options.adaptive.has_value()};
    const Given varying{"layers of varying height", heights.given || adaptive.given};
    struct Choice {
        Given option;
        std::vector<Given> without;
        std::string_view reason;
    };
    const std::array<Choice, 4> choices{
        {{z_list, {layer_height, first_height, heights, adaptive}, "the list says where to cut"},
         {heights, {adaptive}, "each says how high layers are"},
         {adaptive, {layer_height}, "layers differ in height then"},
         {first_height, {varying}, "--heights can say how high the first one is"}}};
    for (const Choice& choice : choices)
        for (const Given& other : choice.without)
            check_conflict(choice.option.given, other.given,
                           fmt::format("{} and {}", choice.option.name, other.name), choice.reason);
}

Cut cut_of(const LayeringOptions& options, std::uint64_t max_memory) {
    if (!options.z_list.empty())
        return ListedPlanes{.z = read_z_list(options.z_list, max_memory)};
    if (options.adaptive) {
        AdaptiveLayers layers{.min_height = options.adaptive->first, .max_height = options.adaptive->second};
        layers.cusp_mm = options.cusp.value_or(layers.cusp_mm);
        return layers;
    }
    const double layer_height = options.layer_height.value_or(UniformLayers{}.layer_height);
    if (!options.heights.empty())
        return HeightRanges{.ranges = options.heights, .layer_height = layer_height};
    return UniformLayers{.layer_height = layer_height, .first_layer_height = options.first_layer_height};
}

} // namespace

Layering LayeringOptions::layering(std::uint64_t max_memory) const {
    check_ways(*this);
    return {.cut = cut_of(*this, max_memory),
            .at = slice_at_named(slice_at),
            .only = only,
            .snap_mm = snap.value_or(0)};
}

Option snap_option(std::optional<double>& target) {
    return length(
        "snap",
        "treat vertices at most this far from a plane as lying on it, such as those of faces that are "
        "horizontal except for rounding; less than half of the thinnest layer",
        target);
}

OptionGroup layering_options(LayeringOptions& target) {
    Option layer_height = length("layer-height", "thickness of a layer", target.layer_height);
    layer_height.preset = exact(UniformLayers{}.layer_height);
    Option cusp = length("cusp", "largest distance of the steps of --adaptive from the surface", target.cusp);
    cusp.goes_with = "adaptive";
    cusp.preset = exact(AdaptiveLayers{}.cusp_mm);
    return {"layers",
            "Layers",
            {std::move(layer_height),
             length("first-layer-height", "thickness of the first layer, if different",
                    target.first_layer_height),
             choice("slice-at", "WHERE", "height within a layer at which it is cut", slice_at_names(),
                    target.slice_at),
             row("z-range", ValueKind::text, "A:B",
                 "only layers whose cut is between z = A and z = B; either end may be omitted",
                 [&target](const std::string& text) { target.only.z_range = parse_range(text); }),
             row("layers", ValueKind::text, "A:B",
                 "only layers A to B - 1 of all, counted from 0; either end may be omitted",
                 [&target](const std::string& text) { target.only.index_range = parse_index_range(text); }),
             input_file("z-list",
                        "cut at the heights listed in this file instead: one per line, # starts a comment; "
                        "or a JSON list",
                        target.z_list),
             row("heights", ValueKind::text, "A:B=H,...",
                 "layers of height H from A to B mm above the bottom; elsewhere --layer-height applies",
                 [&target](const std::string& text) { target.heights = parse_height_ranges(text); }),
             row("adaptive", ValueKind::text, "MIN:MAX",
                 "layers between these heights, each as high as the slopes of the surface allow",
                 [&target](const std::string& text) {
                     if (text.starts_with(':') || text.ends_with(':'))
                         throw Error(ErrorKind::usage,
                                     fmt::format("\"{}\" names one height; both are needed, such as 0.05:0.3",
                                                 excerpt(text)));
                     target.adaptive = parse_range(text);
                 }),
             std::move(cusp), snap_option(target.snap)}};
}

} // namespace lamella::app
