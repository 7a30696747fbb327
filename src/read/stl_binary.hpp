#pragma once

// Binary STL: 80 bytes of header, a count, and records of 50 bytes. Nothing is parsed: the mesh is a view of
// the records.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "core/byte_source.hpp"
#include "read/remarks.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace lamella {

inline constexpr std::size_t stl_head_bytes = 84;
inline constexpr std::size_t stl_record_bytes = 50;

/// What the count field (bytes 80 to 83) says. The file has at least stl_head_bytes.
[[nodiscard]] std::uint32_t stl_declared_count(std::span<const std::byte> bytes);

/// The triangles of a binary file whose size and count field may disagree.
struct StlExtent {
    std::uint64_t triangles = 0;
    std::string remark; ///< what is odd and what was made of it; empty when size and count agree
};

/// The count is believed as far as the file goes; 0 and 2^32 - 1 stand for "not known", as programs that
/// write without seeking back leave it.
[[nodiscard]] StlExtent stl_extent(std::uint64_t file_bytes, std::uint32_t declared);

/// Reads a file of at least stl_head_bytes that is taken for binary.
[[nodiscard]] MeshFile read_stl_binary(const ByteSource& source, const MeshReadOptions& options,
                                       const Execution& execution);

/// Tells that `count` of the file's triangles are not finite, `first` the first of them (from 0), if any are.
/// Throws Error{input} where no other is left.
void judge_nonfinite(std::uint64_t count, std::uint64_t first, std::uint64_t stored, Remarks& remarks);

/// Hands the same triangles to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl_binary(const ByteSource& source, const TriangleSink& sink,
                                         const MeshReadOptions& options, const Execution& execution,
                                         const std::optional<RecordRange>& share);

} // namespace lamella
