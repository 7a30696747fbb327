#pragma once

// Options and reports of the check of a print.

#include "lamella/jobs/print_check.hpp"
#include "lamella/slices/layer_page.hpp"

#include "command.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lamella::app {

struct PrintCheckArguments {
    std::optional<double> touch_mm2;
    std::optional<double> overhang_angle;

    [[nodiscard]] bool given() const noexcept { return touch_mm2 || overhang_angle; }
    /// Returns the options; `max_memory` is the limit of the process in bytes, 0 for none.
    [[nodiscard]] PrintCheckOptions options(std::uint64_t max_memory) const;
};
[[nodiscard]] std::vector<Option> print_check_options(PrintCheckArguments& target);

/// Returns islands, cavities, findings and the largest areas.
[[nodiscard]] Json print_check_json(const PrintCheck& check);
/// Returns the areas of a layer.
[[nodiscard]] Json peel_json(const PeelArea& layer);
/// Returns lines for people: the findings, and the first regions of each kind.
[[nodiscard]] std::string print_check_text(const PrintCheck& check);

/// Return a section of a page with the numbers of findings, and a mark for each of the first regions of each
/// kind: a line over its heights, through the centroid of its first layer.
[[nodiscard]] PageSection print_check_section(const PrintCheck& check);
[[nodiscard]] std::vector<PageLocation> places_of(const PrintCheck& check);

} // namespace lamella::app
