#pragma once

// STL: is it binary or ASCII, or something else under its name?

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "core/byte_source.hpp"

#include <cstdint>
#include <optional>

namespace lamella {

/// Whether it is STL beyond doubt: rules 1 and 2 of read_stl.
[[nodiscard]] bool is_stl(const ByteSource& source);

/// Reads an STL file of either form; the contract of read_mesh. The content decides, because many binary
/// files begin with "solid" as the ASCII form does:
///   1. a size of exactly 84 + 50 * count bytes: binary;
///   2. "solid", a name, and then a facet or "endsolid": ASCII;
///   3. other text: an error that says what was found;
///   4. at least 84 bytes: binary with a wrong count.
[[nodiscard]] MeshFile read_stl(const ByteSource& source, const MeshReadOptions& options,
                                const Execution& execution);

/// By the same rules: how many records a binary file holds, as far as its head and its length tell; nothing
/// for an ASCII file.
[[nodiscard]] std::optional<std::uint64_t> stl_records(const ByteSource& source);

/// Hands the triangles of either form to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl(const ByteSource& source, const TriangleSink& sink,
                                  const MeshReadOptions& options, const Execution& execution,
                                  const std::optional<RecordRange>& share);

} // namespace lamella
