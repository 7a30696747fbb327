#pragma once

// The rule for vertices that lie exactly on a plane.

#include "lamella/core/api.hpp"

#include <optional>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// The side of a plane to which a vertex on it belongs; see docs/conventions.md, "The rule of the plane".
/// Every vertex therefore counts as below or above a plane:
///                          v.z < z   v.z == z   v.z > z
///     section_above         below     below      above     the layer is the section just above z
///     section_below         below     above      above     the layer is the section just below z
enum class PlaneRule { section_above, section_below };

/// Returns the name that files use: "section_above" or "section_below".
[[nodiscard]] constexpr std::string_view plane_rule_name(PlaneRule rule) noexcept {
    return rule == PlaneRule::section_below ? "section_below" : "section_above";
}

/// Returns the rule of this name, or nullopt for any other text.
[[nodiscard]] constexpr std::optional<PlaneRule> plane_rule(std::string_view name) noexcept {
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below})
        if (name == plane_rule_name(rule))
            return rule;
    return std::nullopt;
}

} // namespace lamella
LAMELLA_API_END
