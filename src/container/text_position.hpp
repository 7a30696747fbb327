#pragma once

// Describes a position in a text: its line, and the text there.

#include "lamella/core/printable.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lamella {

/// Returns the number of the line with byte `offset`, counted from 1. Lines end with LF, CRLF or a bare CR.
/// O(offset).
[[nodiscard]] std::uint64_t line_at(std::string_view text, std::size_t offset);

} // namespace lamella
