#pragma once

// Lists of heights to cut at.

#include <string>
#include <vector>

namespace lamella::app {

/// The numbers of a text file, one a line with # comments, or of a JSON array. Throws Error{usage} with the
/// line of what is no number or not above the one before it, Error{input} when the file cannot be read or
/// lists nothing.
[[nodiscard]] std::vector<double> read_z_list(const std::string& path);

} // namespace lamella::app
