#pragma once

// Options for the heights at which a mesh is cut.

#include "lamella/slicing/layering.hpp"

#include "command.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {

struct LayeringOptions {
    std::optional<double> layer_height;
    std::optional<double> first_layer_height;
    std::string slice_at = "middle";
    PlaneSelection only;
    std::string z_list;
    std::vector<HeightRange> heights;
    std::optional<std::pair<double, double>> adaptive;
    std::optional<double> cusp;
    std::optional<double> snap;

    [[nodiscard]] bool given() const {
        return layer_height || first_layer_height || slice_at != "middle" || only.z_range ||
               only.index_range || !z_list.empty() || !heights.empty() || adaptive || cusp || snap;
    }
    /// Returns the layering that the options define; reads the list of z if there is one. Throws Error{usage}
    /// for options that contradict each other, and the errors of read_z_list, which gets `max_memory`.
    [[nodiscard]] Layering layering(std::uint64_t max_memory) const;
};

[[nodiscard]] Option snap_option(std::optional<double>& target);

[[nodiscard]] OptionGroup layering_options(LayeringOptions& target);

/// Parses "0:5=0.1,5:20=0.2". Throws Error{usage}. Does not check whether ranges overlap, which
/// plan_by_ranges does.
[[nodiscard]] std::vector<HeightRange> parse_height_ranges(std::string_view text);

} // namespace lamella::app
