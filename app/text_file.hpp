#pragma once

// Small text files and standard output.

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella::app {

/// The whole file; "-" is standard input. Throws Error{input}, and Error{limit} for one of more than `most`
/// bytes; 0: any number.
[[nodiscard]] std::string read_text_file(const std::string& path, std::uint64_t most = 0);

/// Writes to a temporary name and renames, so that nobody sees half a file; special files are written in
/// place. "-" is standard output. Throws Error{output}.
void write_text_file(const std::string& path, std::string_view text);

/// Prints a result on standard output. Throws Error{output}.
void print(std::string_view text);

/// Makes sure that everything printed has arrived. Throws Error{output}.
void finish_printing();

} // namespace lamella::app
