#pragma once

// Files that appear complete or not at all.

#include "lamella/core/api.hpp"

#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Writes a file that appears complete or not at all. An existing file of that name is replaced and its
/// permissions are kept; a symbolic link stays, and the file that it points to is replaced. "-" is standard
/// output. Standard output, pipes and devices are written in place. Throws Error{output}.
void write_whole_file(const std::string& path, std::string_view bytes);

/// Throws the Error{output} that write_whole_file would throw at its start, for example if the folder does
/// not exist or is not writable. A job that calls it first fails before its work instead of after it. Leaves
/// no file behind, and does not touch standard output, pipes and devices.
void check_writable(const std::string& path);

/// Removes all files and folders that writers of this process have under temporary names, on all threads;
/// afterwards no writer can create a new one. A program needs this only if it is about to call _exit, because
/// it is stuck or was interrupted twice; otherwise the destructors of the writers remove the files.
///
/// Async-signal-safe: it takes no lock and allocates no memory. A folder that is being renamed to its final
/// name at the same moment may keep its temporary name.
void remove_unfinished() noexcept;

} // namespace lamella
LAMELLA_API_END
