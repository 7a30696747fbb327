#pragma once

// Binary STL: 80 bytes of header, a count, and records of 50 bytes. The mesh is a view of the records of a
// file in memory, or a copy of the corners in other files.

#include "lamella/core/execution.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "meshes/remarks.hpp"
#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace lamella {

inline constexpr std::size_t stl_header_bytes = 84;
inline constexpr std::size_t stl_record_bytes = 50;
/// Bytes of the normal before the corners; normals are often wrong and not used.
inline constexpr std::size_t stl_normal_bytes = 12;

/// Returns the count field (bytes 80 to 83). The file must have at least stl_header_bytes.
[[nodiscard]] std::uint32_t stl_declared_count(std::span<const std::byte> bytes);

/// The triangles of a binary file; its size and its count field may disagree.
struct StlExtent {
    std::uint64_t triangles = 0;
    std::string remark; ///< the irregularity, and how it was treated; empty if size and count agree
};

/// Computes the extent. The count is used unless the file has fewer records. Counts of 0 and 2^32 - 1 mean
/// "unknown", because programs that cannot seek back leave these values.
[[nodiscard]] StlExtent stl_extent(std::uint64_t file_bytes, std::uint32_t declared);

/// Reads a binary file of at least stl_header_bytes.
[[nodiscard]] MeshFile read_stl_binary(const ByteSource& source, const MeshReadOptions& options,
                                       const Execution& execution);

/// If `count` is not 0, warns that this many triangles are not finite; `first` is the index of the first one.
/// Throws Error{input} if no triangle is left.
void judge_nonfinite(std::uint64_t count, std::uint64_t first, std::uint64_t stored, Remarks& remarks);

/// Passes the triangles to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl_binary(const ByteSource& source, const TriangleSink& sink,
                                         const MeshReadOptions& options, const Execution& execution,
                                         const std::optional<RecordRange>& share);

} // namespace lamella
