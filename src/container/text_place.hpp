#pragma once

// Naming a place in a text to a person: its line, and what stands there.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// The line that holds byte `offset`, counted from 1. Lines end with LF, CRLF or a bare CR. O(offset).
[[nodiscard]] std::uint64_t line_at(std::string_view text, std::size_t offset);

/// The text as one line of valid UTF-8: control characters, malformed bytes, and U+FFFE and U+FFFF become
/// \xNN. What is longer than `max_bytes` is cut at a character and ends in "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_bytes);

} // namespace lamella
