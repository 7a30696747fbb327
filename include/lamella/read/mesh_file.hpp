#pragma once

// Reading meshes: what the file says, nothing welded, nothing repaired.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

enum class MeshFormat { stl_binary, stl_ascii };

/// "stl-binary", "stl-ascii".
[[nodiscard]] const char* format_name(MeshFormat format) noexcept;

struct MeshReadOptions {
    /// Make an error of what is otherwise a warning: wrong counts, truncation, corners that are not finite.
    bool strict = false;
};

struct MeshFile {
    std::string path;
    MeshFormat format = MeshFormat::stl_binary;
    std::string name;                      ///< the solid's name or the header's text, where there is one
    TriangleSoup mesh;                     ///< finite corners only
    std::uint64_t stored_triangles = 0;    ///< including those that were dropped
    std::uint64_t nonfinite_triangles = 0; ///< dropped, because a corner was NaN or infinite
    std::vector<std::string> warnings;     ///< one line each: what was odd and what was made of it
};

/// Reads an STL file, binary or ASCII by its content. "-" reads standard input. Binary files are
/// memory-mapped and viewed, not copied (but for dropped triangles), so the file must not change while the
/// mesh lives. Parallel; O(bytes).
///
/// Accepted with a warning: a wrong or absent count, trailing bytes, a truncated last triangle, corners that
/// are not finite (dropped). Throws Error{input} with file, byte or line, what was found and what was
/// expected for anything else, also for a file without any triangle.
[[nodiscard]] MeshFile read_mesh(const std::string& path, const MeshReadOptions& options = {},
                                 const Execution& execution = {});

/// The same from bytes in memory (copied); `name` stands for the path in errors.
[[nodiscard]] MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name,
                                 const MeshReadOptions& options = {}, const Execution& execution = {});

} // namespace lamella
