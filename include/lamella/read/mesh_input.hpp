#pragma once

// Mesh files that may be larger than memory: opened first, looked at, and then read whole or batch by batch.

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

/// Receives the triangles of a file, some ten thousand at a time: from several threads at once and in any
/// order. `number` counts the batches in the order of the file (a batch of which nothing is usable is left
/// out). The batch is a view: its memory is let go of when the call returns. May throw: reading stops and the
/// exception reaches the caller.
using TriangleSink = std::function<void(const TriangleSoup& batch, std::uint64_t number)>;

/// Triangles [begin, end) of a binary STL file, as stored.
struct RecordRange {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
};

/// A mesh file that is open. Cheap to copy; copies are the same file.
class MeshInput {
  public:
    /// "-" is standard input. A binary STL file stays open and is read in windows.
    /// Any other input is copied here: no more than `most_in_memory` bytes to memory (unless given, a quarter
    /// of what MeshReadOptions::max_memory is by default), a longer one to a temporary file without a name
    /// (in $TMPDIR, else /var/tmp). Throws Error{input} when there is no such file or it may not be read,
    /// Error{output} when there is no room for the temporary file, Error{cancelled}.
    explicit MeshInput(const std::string& path, std::optional<std::uint64_t> most_in_memory = {},
                       const Execution& execution = {});

    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept;
    /// How many of them are in memory.
    [[nodiscard]] std::uint64_t bytes_in_memory() const noexcept;

    /// Whether `stream` can read it: STL that is not packed, even with a wrong count or cut off.
    /// Throws what `read` throws for files of unknown formats.
    [[nodiscard]] bool can_stream() const;
    /// How many triangles a binary STL file holds, as far as its head and its length tell, usable or not;
    /// nothing for other files.
    [[nodiscard]] std::optional<std::uint64_t> records() const;

    /// Reads all of it: see read_mesh.
    [[nodiscard]] MeshFile read(const MeshReadOptions& options = {}, const Execution& execution = {}) const;

    /// Hands all triangles to the sink, in the memory of some batches for each thread, however large the file
    /// is. The same checks, errors and warnings as in `read`; the result is the same but for the mesh of its
    /// only object, which is empty. May be called any number of times. Progress counts bytes.
    ///
    /// `share`: only these triangles of a binary file; `nonfinite_triangles` and `first_nonfinite` are of
    /// those. To warn of them, or that none of the file is usable, is left to whoever knows all shares.
    /// `stored_triangles` and `max_triangles` are of the whole file, in which the head counts them. Throws
    /// Error{usage} when the file has fewer, for a share of an ASCII file, and for a file that cannot be
    /// streamed.
    MeshFile stream(const TriangleSink& sink, const MeshReadOptions& options = {},
                    const Execution& execution = {}, const std::optional<RecordRange>& share = {}) const;

  private:
    std::string path_;
    std::shared_ptr<const ByteSource> source_;
};

} // namespace lamella
LAMELLA_API_END
