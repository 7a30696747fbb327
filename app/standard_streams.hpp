#pragma once

// Standard input and output, as whoever started the program left them.

#include <string>

namespace lamella::app {

/// Takes the descriptors 0 to 2 where they are closed: else the next file that is opened would get such a
/// number, and be read or written in place of the stream. Reading or writing such a stream stays an error. To
/// be called before anything is opened.
void reserve_standard_streams() noexcept;

/// Whether standard output was closed from the start: then nobody wants to be told anything.
[[nodiscard]] bool output_is_closed() noexcept;

/// As messages call a file to read: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);
/// The same of a file to write: "standard output".
[[nodiscard]] std::string output_name(const std::string& path);

} // namespace lamella::app
