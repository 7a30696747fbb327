#pragma once

// Names of files in messages.

#include <string>

namespace lamella::app {

/// Returns the name that messages use for an input file: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);
/// Returns the name that messages use for an output file: its path, or "standard output" for "-".
[[nodiscard]] std::string output_name(const std::string& path);

} // namespace lamella::app
