#pragma once

// Suggestions for mistyped names.

#include "lamella/core/api.hpp"

#include <span>
#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the candidate of which `word` could be a mistyped form; "" if none is similar enough.
[[nodiscard]] std::string nearest(std::string_view word, std::span<const std::string> candidates);
/// Returns "; did you mean NAME?" with that name, or "" if there is none.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

} // namespace lamella
LAMELLA_API_END
