#pragma once

// Names of files and parts of a plate in error messages.

#include "lamella/jobs/plate.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// Returns the name of the whole plate: "a.stl", "a.stl and 2 more files".
[[nodiscard]] std::string name_of(std::span<const PlateInput> inputs);
[[nodiscard]] std::string name_of(const Plate& plate);

/// Returns the name of a part: its file, and its label if the file has several parts: "a.stl", "plate.3mf,
/// part "ball"".
[[nodiscard]] std::string name_of_part(const Plate& plate, std::size_t part);
/// Returns the names of all parts. O(parts).
[[nodiscard]] std::vector<std::string> names_of_parts(const Plate& plate);
/// Returns the name of the first part of a shape. It includes the label if the file has several shapes.
[[nodiscard]] std::string name_of_shape(const Plate& plate, std::size_t shape);

} // namespace lamella
