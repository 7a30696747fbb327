#pragma once

// ASCII STL: words between blanks; line ends count as blanks.
//
//     solid NAME
//       facet normal 0 0 1
//         outer loop
//           vertex 0 0 0
//           vertex 1 0 0
//           vertex 0 1 0
//         endloop
//       endfacet
//     endsolid NAME

#include "lamella/core/execution.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "system/byte_source.hpp"

#include <string_view>

namespace lamella {

/// Returns whether the text begins with the word "solid", after a byte order mark and blanks.
[[nodiscard]] bool begins_with_solid(std::string_view text);

/// Returns whether the text begins with "solid", a name, and then a facet or "endsolid". A name ends at the
/// end of its line or at a facet, because some files consist of one line.
[[nodiscard]] bool is_stl_ascii(std::string_view text);

/// Reads a text that begins with "solid". Keywords may be in any case. All solids are joined. Normals are
/// skipped and may be missing; other words in their position cause a warning. Runs in parallel, with the same
/// result and errors as a sequential parser.
[[nodiscard]] MeshFile read_stl_ascii(const ByteSource& source, const MeshReadOptions& options,
                                      const Execution& execution);

/// Passes the triangles to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl_ascii(const ByteSource& source, const TriangleSink& sink,
                                        const MeshReadOptions& options, const Execution& execution);

} // namespace lamella
