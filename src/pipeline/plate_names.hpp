#pragma once

// What errors call what is on a plate.

#include "lamella/pipeline/plate.hpp"

#include <cstddef>
#include <span>
#include <string>

namespace lamella {

/// All of it: "a.stl", "a.stl and 2 more files".
[[nodiscard]] std::string name_of(std::span<const PlateInput> inputs);
[[nodiscard]] std::string name_of(const Plate& plate);

/// A part: its file, and its label where that has several parts: "a.stl", "plate.3mf, part "ball"".
[[nodiscard]] std::string name_of_part(const Plate& plate, std::size_t part);
/// The first part of a shape: with its label where its file has several shapes.
[[nodiscard]] std::string name_of_shape(const Plate& plate, std::size_t shape);

} // namespace lamella
