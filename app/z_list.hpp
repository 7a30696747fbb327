#pragma once

// Lists of heights for cuts.

#include <cstdint>
#include <string>
#include <vector>

namespace lamella::app {

/// Reads the numbers of a text file, one per line and with # comments, or those of a JSON array. Throws
/// Error{usage} with the line of an entry that is not a number or not above the one before it, Error{input}
/// if the file cannot be read or is empty. With `max_memory`, other than 0, throws Error{limit} for a file
/// above a quarter of it and 1 MB, and for more heights than have planes that fit into it.
[[nodiscard]] std::vector<double> read_z_list(const std::string& path, std::uint64_t max_memory);

} // namespace lamella::app
