#pragma once

// Files that appear whole or not at all.

#include "lamella/core/api.hpp"

#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Writes a file that appears whole or not at all. One of that name that is there already is replaced and
/// keeps its permissions; through a symbolic link, the file that the link points to is. "-" is standard
/// output; that, pipes and devices are written in place. Throws Error{output}.
void write_whole_file(const std::string& path, std::string_view bytes);

/// Throws the Error{output} with which write_whole_file would begin, such as for a folder that does not exist
/// or may not be written; so what is written last fails before the work. Nothing is left; standard output,
/// pipes and devices are not touched.
void check_writable(const std::string& path);

/// Removes every file and folder that writers of this process have under a temporary name, whichever thread
/// they run on; from then on no writer begins a new one. For a program that is about to leave by _exit, since
/// it is stuck or was told twice to stop: everybody else gets the same from the writers' destructors.
///
/// Async-signal-safe: it takes no lock and no memory. A folder that gets its final name at the same moment
/// may keep its temporary one.
void remove_unfinished() noexcept;

} // namespace lamella
LAMELLA_API_END
