#pragma once

// Text from outside, such as names and lines of files, made fit for messages.

#include "lamella/core/api.hpp"

#include <cstddef>
#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// The text as one line of valid UTF-8: control characters, malformed bytes, and U+FFFE and U+FFFF become
/// \xNN. What is longer than `max_bytes` is cut at a character and ends in "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_bytes = std::string_view::npos);

/// What errors and warnings quote of a text at most, in bytes.
inline constexpr std::size_t most_quoted = 200;

/// The text as errors and warnings quote it: printable, and no longer than that.
[[nodiscard]] inline std::string excerpt(std::string_view text) {
    return printable(text, most_quoted);
}

} // namespace lamella
LAMELLA_API_END
