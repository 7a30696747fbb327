#pragma once

// Standard input and output, as inherited from the parent process.

#include <string>

namespace lamella::app {

/// Occupies the descriptors 0 to 2 if they are closed: else the next file to be opened would get such a
/// number, and be read or written instead of the stream. Reading or writing such a stream stays an error.
/// Must be called before any file is opened.
void reserve_standard_streams() noexcept;

/// Returns whether standard output was closed from the start: then no output is wanted.
[[nodiscard]] bool output_is_closed() noexcept;

/// Returns the name of a file to read in messages: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);
/// Returns the same for a file to write: "standard output".
[[nodiscard]] std::string output_name(const std::string& path);

} // namespace lamella::app
