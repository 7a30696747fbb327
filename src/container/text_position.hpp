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

/// Returns lines of a text, fast near the offset of the last call.
class LineCounter {
  public:
    /// The line with byte `offset` is known.
    explicit LineCounter(std::string_view text, std::size_t offset = 0, std::uint64_t line = 1)
        : text_(text), offset_(offset), line_(line) {}

    /// Returns the number of the line with this byte. O(distance to the offset of the last call).
    [[nodiscard]] std::uint64_t line(std::size_t offset);

  private:
    std::string_view text_;
    std::size_t offset_;
    std::uint64_t line_;
};

} // namespace lamella
