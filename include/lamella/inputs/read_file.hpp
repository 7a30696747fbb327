#pragma once

// Reads files of meshes and of layers; their formats are recognised by their content.

#include "lamella/core/execution.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/slices/layer_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct ByteSource;

/// Returns the extensions of mesh files, in lower case: "stl", "3mf"...
[[nodiscard]] std::vector<std::string_view> mesh_extensions();

/// Returns whether a name or path has one of the `mesh_extensions`, in upper or lower case, with or without a
/// further ".gz".
[[nodiscard]] bool is_mesh_name(const std::string& name);

/// Reads a mesh file; its format is recognised by its content. "-" reads standard input. docs/formats.md
/// describes the accepted subset of each format.
///
/// The bytes are copied, except those of binary STL files of at least 64 KiB, which are read in chunks: the
/// file may change during the call and is not needed afterwards. Throws
/// Error{input} if the file becomes shorter while it is copied. A copy of more than a quarter of `max_memory`
/// is kept in an anonymous temporary file (in $TMPDIR, else /var/tmp, else /tmp), of which the mesh of a
/// binary STL file is a view; throws Error{output} if the disk is full.
///
/// Corners of STL files have single precision, in ASCII files too: each number there is rounded once, to the
/// nearest. So an ASCII file with at least nine significant digits gives the same slices as the binary file,
/// bit for bit. Stored normals are ignored. All solids of an ASCII file are joined.
///
/// These defects are accepted with a warning: a wrong or missing count, trailing bytes or text, a missing
/// "endsolid", a truncated last triangle, and corners that are not finite (their triangles are dropped). For
/// other defects, and for a file without any usable triangle, throws Error{input} that reports the file, the
/// byte or line, the text found and the text expected.
///
/// O(bytes), parallel; the result does not depend on the number of threads.
[[nodiscard]] MeshFile read_mesh(const std::string& path, const MeshReadOptions& options = {},
                                 const Execution& execution = {});

/// Reads a copy of bytes in memory; `name` replaces the path in errors.
[[nodiscard]] MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name,
                                 const MeshReadOptions& options = {}, const Execution& execution = {});

/// Reads a slice file and recognises its format by the content: Common Layer Interface (binary or ASCII),
/// layered SVG, SLC, 3MF with slice stacks, layers as JSON, NumPy arrays, ILT, Open Vector Format or 3MF with
/// toolpaths. Each may be compressed with gzip. "-" reads standard input. Layers are in ascending z. Layers
/// without an exposure are in normal form. Values that the format does not store are derived from others. For
/// example, the Common Layer Interface stores only the tops of layers, so the cut is assumed to be half-way
/// up. Throws Error{input} that reports the file, the byte or line, the text found and the text expected.
[[nodiscard]] LayerFile read_layers(const std::string& path, const LayerReadOptions& options = {},
                                    const Execution& execution = {});

/// Reads bytes in memory; `name` replaces the path in errors.
[[nodiscard]] LayerFile read_layers(std::span<const std::byte> bytes, const std::string& name,
                                    const LayerReadOptions& options = {}, const Execution& execution = {});

/// Reads a mesh file or a slice file, whose format is recognised by its content, with the results and errors
/// of `read_mesh` or `read_layers`. If a package such as 3MF contains layers and meshes, the layers are read,
/// because the meshes usually are only a preview of them. "-" reads standard input. `max_memory` also applies
/// to layers.
[[nodiscard]] std::variant<MeshFile, LayerFile>
read_any(const std::string& path, const MeshReadOptions& options = {}, const Execution& execution = {});

/// Reads bytes in memory; `name` replaces the path in errors.
[[nodiscard]] std::variant<MeshFile, LayerFile> read_any(std::span<const std::byte> bytes,
                                                         const std::string& name,
                                                         const MeshReadOptions& options = {},
                                                         const Execution& execution = {});

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
