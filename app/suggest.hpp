#pragma once

// What was probably meant.

#include <span>
#include <string>
#include <string_view>

namespace lamella::app {

/// The candidate that a slip of the fingers turns into `word`, or "" when none is near.
[[nodiscard]] std::string nearest(std::string_view word, std::span<const std::string> candidates);

} // namespace lamella::app
