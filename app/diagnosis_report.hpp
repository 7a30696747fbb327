#pragma once

// Report of `lamella info` about a mesh: size, shells, and defects with their locations.

#include "lamella/jobs/plate.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "messages.hpp"

#include <cstdint>
#include <string>

namespace lamella::app {

/// Upper bound on the memory of welding and diagnosis, for each triangle of a mesh in memory.
inline constexpr std::uint64_t diagnosis_bytes_per_triangle = 128;

[[nodiscard]] std::string mesh_text(const MeshFile& file, const Diagnosis& found, const Plate& plate);
[[nodiscard]] Json mesh_json(const MeshFile& file, const Diagnosis& found, const Plate& plate);

} // namespace lamella::app
