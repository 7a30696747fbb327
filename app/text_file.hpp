#pragma once

// Small text files and standard output.

#include <string>
#include <string_view>

namespace lamella::app {

/// The whole file, without a byte order mark, as some editors put it; "-" is standard input. Throws
/// Error{input}.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// As write_whole_file, but for "-", which is printed. Throws Error{output}.
void write_text_file(const std::string& path, std::string_view text);

/// Prints a result on standard output. Throws Error{output}.
void print(std::string_view text);

/// Makes sure that everything printed has arrived. Throws Error{output}.
void finish_printing();

} // namespace lamella::app
