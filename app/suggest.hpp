#pragma once

// Suggestions for mistyped names.

#include <span>
#include <string>
#include <string_view>

namespace lamella::app {

/// Returns the candidate that a typing error could turn into `word`, or "" if none is near.
[[nodiscard]] std::string nearest(std::string_view word, std::span<const std::string> candidates);

} // namespace lamella::app
