#pragma once

// Naming a place in a text to a person: its line, and what stands there.

#include "lamella/core/printable.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lamella {

/// The line that holds byte `offset`, counted from 1. Lines end with LF, CRLF or a bare CR. O(offset).
[[nodiscard]] std::uint64_t line_at(std::string_view text, std::size_t offset);

} // namespace lamella
