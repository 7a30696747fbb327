#pragma once

// ASCII STL: words between blanks, whatever the lines.
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
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "core/byte_source.hpp"

#include <string_view>

namespace lamella {

/// Whether the text begins with the word "solid" (after a byte order mark and blanks).
[[nodiscard]] bool begins_with_solid(std::string_view text);

/// Whether the text begins with "solid", a name, and then a facet or "endsolid". A name runs to the end of
/// its line, but ends where a facet begins, as whole files on one line exist.
[[nodiscard]] bool is_stl_ascii(std::string_view text);

/// Reads a text that begins with "solid". Keywords in any case; any number of solids, taken together; normals
/// are skipped, also when they are missing, and with a warning where other words stand in their place. In
/// parallel, with the same result, errors included, as from front to back.
[[nodiscard]] MeshFile read_stl_ascii(const ByteSource& source, const MeshReadOptions& options,
                                      const Execution& execution);

/// Hands the same triangles to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl_ascii(const ByteSource& source, const TriangleSink& sink,
                                        const MeshReadOptions& options, const Execution& execution);

} // namespace lamella
