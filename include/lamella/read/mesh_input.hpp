#pragma once

// Mesh files that may be larger than memory: they are opened and inspected first, then read whole or in
// chunks.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/read/mesh_file.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

LAMELLA_API_BEGIN
namespace lamella {

struct ByteSource;

/// Receives the triangles of a file in chunks of some ten thousand, from several threads at once and in any
/// order. `number` is the index of the chunk in the file; chunks without usable triangles are omitted.
/// `batch` is a view that is valid only during the call. May throw: reading stops and the exception reaches
/// the caller.
using TriangleSink = std::function<void(const TriangleSoup& batch, std::uint64_t number)>;

/// Triangles [begin, end) of a binary STL file, as stored.
struct RecordRange {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
};

/// An open mesh file. Copies are cheap and refer to the same file.
class MeshInput {
  public:
    /// Opens a file; "-" is standard input. A binary STL file stays open and is read in chunks. Any other
    /// input is copied: to memory if it has at most `most_in_memory` bytes (by default a quarter of the
    /// default of MeshReadOptions::max_memory), else to an anonymous temporary file (in $TMPDIR, else
    /// /var/tmp, else /tmp). Throws Error{input} if the file does not exist or cannot be read, Error{output}
    /// if the temporary file does not fit on the disk, Error{cancelled}.
    explicit MeshInput(const std::string& path, std::optional<std::uint64_t> most_in_memory = {},
                       const Execution& execution = {});

    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept;
    /// Returns the number of bytes that are in memory.
    [[nodiscard]] std::uint64_t bytes_in_memory() const noexcept;

    /// Returns whether `stream` can read the file, which is true for uncompressed STL, even with a wrong
    /// count or truncated. Throws the errors of `read` for files of unknown formats.
    [[nodiscard]] bool can_stream() const;
    /// Returns the number of triangles of a binary STL file, usable or not, according to its header and its
    /// length; nullopt for other files.
    [[nodiscard]] std::optional<std::uint64_t> records() const;

    /// Reads the whole file: see read_mesh.
    [[nodiscard]] MeshFile read(const MeshReadOptions& options = {}, const Execution& execution = {}) const;

    /// Passes all triangles to the sink. Takes memory for a few chunks per thread only, for any size of file.
    /// Checks, errors, warnings and the result are those of `read`, except that the mesh of the only object
    /// is empty. May be called any number of times. Progress counts bytes.
    ///
    /// `share` selects a range of the triangles of a binary file; `nonfinite_triangles` and `first_nonfinite`
    /// then refer to this range. The caller knows all ranges; it must warn of these triangles, and must check
    /// that at least one triangle of the file is usable. `stored_triangles` and `max_triangles` refer to the
    /// whole file, by the number in its header. Throws Error{usage} if the file has fewer triangles than the
    /// range, for a range of an ASCII file, and for a file that cannot be streamed.
    MeshFile stream(const TriangleSink& sink, const MeshReadOptions& options = {},
                    const Execution& execution = {}, const std::optional<RecordRange>& share = {}) const;

  private:
    std::string path_;
    std::shared_ptr<const ByteSource> source_;
};

} // namespace lamella
LAMELLA_API_END
