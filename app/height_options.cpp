#include "height_options.hpp"

#include "lamella/core/error.hpp"

#include "numbers.hpp"
#include "options.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace lamella::app {

std::vector<HeightRange> parse_height_ranges(std::string_view text) {
    std::vector<HeightRange> ranges;
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t comma = rest.find(',');
        const std::string_view one = rest.substr(0, comma);
        rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
        const std::size_t equals = one.find('=');
        const std::size_t colon = one.find(':');
        if (equals == std::string_view::npos || colon == std::string_view::npos || colon > equals)
            throw Error(
                ErrorKind::usage,
                fmt::format("\"{}\" is no range of heights; expected one such as 0:5=0.1,5:20=0.2", one));
        ranges.push_back({parse_number(one.substr(0, colon)),
                          parse_number(one.substr(colon + 1, equals - colon - 1)),
                          parse_positive(one.substr(equals + 1))});
    }
    if (ranges.empty())
        throw Error(ErrorKind::usage, "expected ranges such as 0:5=0.1,5:20=0.2");
    return ranges;
}

std::optional<AdaptiveLayers> HeightOptions::adaptive_layers(SliceAt slice_at) const {
    if (!adaptive)
        return std::nullopt;
    AdaptiveLayers layers{
        .min_height = adaptive->first, .max_height = adaptive->second, .slice_at = slice_at};
    layers.cusp_mm = cusp.value_or(layers.cusp_mm);
    return layers;
}

std::vector<Option> height_options(HeightOptions& target) {
    Option cusp = length("cusp", "how far the steps of --adaptive may stand off the surface", target.cusp);
    cusp.goes_with = "adaptive";
    cusp.preset = exact(AdaptiveLayers{}.cusp_mm);
    return {row("heights", ValueKind::text, "A:B=H,...",
                "layers of H from A to B above the bottom, of the layer height elsewhere",
                [&target](const std::string& text) { target.ranges = parse_height_ranges(text); }),
            row("adaptive", ValueKind::text, "MIN:MAX",
                "layers as high as the slopes of the surface allow, between these heights",
                [&target](const std::string& text) { target.adaptive = parse_range(text); }),
            std::move(cusp)};
}

} // namespace lamella::app
