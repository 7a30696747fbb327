#pragma once

// Suggestions for mistyped names.

#include <span>
#include <string>
#include <string_view>

namespace lamella::app {

/// Returns the candidate of which `word` could be a mistyped form; "" if none is similar enough.
[[nodiscard]] std::string nearest(std::string_view word, std::span<const std::string> candidates);
/// Returns "; did you mean NAME?" with that name, or "" if there is none.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

} // namespace lamella::app
