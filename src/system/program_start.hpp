#pragma once

// The needs of the program apart from the library: arguments, standard streams, memory. Programs
// include these headers (program_*.hpp); their sources are no part of the library.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the arguments after the name of the program, in UTF-8 where the system has an encoding.
[[nodiscard]] std::vector<std::string> program_arguments(int argc, char** argv);

/// Prepares the standard streams; must be called before any file is opened. A closed stream must not get the
/// number of the next file that is opened, which would be read or written instead; reading or writing it
/// remains an error. Streams carry bytes unchanged, and UTF-8 to a terminal.
void prepare_standard_streams() noexcept;

/// Returns whether standard output was closed when the program started, which means that no output is wanted.
[[nodiscard]] bool output_is_closed() noexcept;
/// Returns the columns of the terminal on standard error, or nullopt if it is no terminal that can draw a
/// progress bar. A terminal that does not know its size has 80.
[[nodiscard]] std::optional<unsigned> terminal_columns() noexcept;
/// Returns the columns of the terminal on standard output, or nullopt if it is no terminal or does not know
/// its size.
[[nodiscard]] std::optional<unsigned> output_columns() noexcept;

/// Returns the files that a pattern with * and ? names, sorted by name, on a system whose shells leave this
/// to the programs. Only the last part of the path may have such characters; hidden files and folders are
/// left out. Returns nullopt for other texts and on other systems.
[[nodiscard]] std::optional<std::vector<std::string>> files_matching(const std::string& pattern);

/// If the window with the output closes when the program ends, as after a click on its file, asks for a key
/// and waits for it.
void keep_window_open();

/// Reads a file, or standard input if the path is "-", to its end. Returns an errno, or 0; EFBIG as soon as
/// there are more than `most` bytes.
[[nodiscard]] int read_text(const std::string& path, std::string& text, std::uint64_t most);

/// Identifies a file, whatever its path is.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;
[[nodiscard]] std::optional<FileIdentity> identity_of(const std::string& path);

/// Returns the peak memory of this program in bytes.
[[nodiscard]] std::uint64_t peak_memory();

/// Sets two thresholds of the allocator, if the system has them. Freed memory of at least `own_pages` bytes
/// is returned to the system at once, smaller amounts if more than `kept` bytes are free. By default the
/// allocator adapts both thresholds to the sizes that it encounters, and never lowers them again.
void set_heap(int own_pages, int kept) noexcept;

/// Returns the most bytes that a path can have.
[[nodiscard]] std::size_t longest_path() noexcept;

/// Returns a path as a word for a command line of the usual shell, which can be copied into it.
[[nodiscard]] std::string quoted_for_shell(const std::string& path);

} // namespace lamella
