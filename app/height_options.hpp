#pragma once

// The options for layers that differ in height.

#include "lamella/slicing/varying_plan.hpp"

#include "command.hpp"

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {

struct HeightOptions {
    std::vector<HeightRange> ranges;
    std::optional<std::pair<double, double>> adaptive;
    std::optional<double> cusp;

    /// Nothing where --adaptive was not given.
    [[nodiscard]] std::optional<AdaptiveLayers> adaptive_layers(SliceAt slice_at) const;
};

/// To be appended to a group.
[[nodiscard]] std::vector<Option> height_options(HeightOptions& target);

/// "0:5=0.1,5:20=0.2". Throws Error{usage}; whether ranges overlap is for the plan to say.
[[nodiscard]] std::vector<HeightRange> parse_height_ranges(std::string_view text);

} // namespace lamella::app
