#pragma once

// Small text files and standard output.

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella::app {

/// Returns the whole file, without the byte order mark that some editors add; "-" is standard input. A file
/// in UTF-16 with such a mark, which redirections of Windows PowerShell write, is returned in UTF-8. Throws
/// Error{input}, and Error{limit} if it has more than `most` bytes, unless that is 0.
[[nodiscard]] std::string read_text_file(const std::string& path, std::uint64_t most = 0);

/// Writes the file like write_whole_file, except that "-" is printed. Throws Error{output}.
void write_text_file(const std::string& path, std::string_view text);

/// Prints a result on standard output. Throws Error{output}.
void print(std::string_view text);

/// Makes sure that everything printed has been written. Throws Error{output}.
void finish_printing();

} // namespace lamella::app
