#pragma once

// AMF (ISO/ASTM 52915): objects as meshes in XML, plain or in a zip archive, and constellations of them.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

#include <string_view>

namespace lamella {

/// Whether the text begins as an AMF file does, as far as one can tell before reading it.
[[nodiscard]] bool is_amf(std::string_view text);

/// Reads an AMF file; the contract of read_mesh. The volumes of an object make one mesh, those of type
/// support only where the options ask for them. Objects that no constellation places stand where they are.
/// Edges and normals, which bend triangles, are passed over with a warning. Angles are degrees, but radians
/// in the files of Slic3r and its descendants, which also know scale, mirror and printable.
[[nodiscard]] MeshFile read_amf(const ByteSource& source, const MeshReadOptions& options,
                                const Execution& execution);

} // namespace lamella
