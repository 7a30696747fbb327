#pragma once

// Standard input and output, as inherited from the parent process.

#include <string>

namespace lamella::app {

/// Occupies the descriptors 0 to 2 if they are closed. Otherwise the next file to be opened would get such a
/// number, and would be read or written instead of the stream. Reading or writing a closed stream remains an
/// error. Must be called before any file is opened.
void reserve_standard_streams() noexcept;

/// Returns whether standard output was closed when the program started, which means that no output is wanted.
[[nodiscard]] bool output_is_closed() noexcept;

/// Returns the name that messages use for an input file: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);
/// Returns the name that messages use for an output file: its path, or "standard output" for "-".
[[nodiscard]] std::string output_name(const std::string& path);

} // namespace lamella::app
