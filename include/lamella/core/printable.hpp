#pragma once

// Makes external text, such as names and lines of files, suitable for messages.

#include "lamella/core/api.hpp"

#include <cstddef>
#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the text as one line of valid UTF-8. Control characters (also of bidirectional text), malformed
/// bytes, U+FFFE and U+FFFF become \xNN. Text of more than `max_bytes` bytes is cut after a whole character
/// and ends in "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_bytes = std::string_view::npos);

/// Returns whether the text is valid UTF-8.
[[nodiscard]] bool is_utf8(std::string_view text) noexcept;

/// Largest number of bytes that errors and warnings quote of a text.
inline constexpr std::size_t most_quoted = 200;

/// Returns the first `most_quoted` bytes of the text in printable form, for errors and warnings.
[[nodiscard]] inline std::string excerpt(std::string_view text) {
    return printable(text, most_quoted);
}

} // namespace lamella
LAMELLA_API_END
