#pragma once

// Reads meshes as the file describes them, without welding or repair.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/read/mesh_role.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the extensions of mesh files, in lower case: "stl", "3mf"...
[[nodiscard]] std::vector<std::string_view> mesh_extensions();

/// Returns whether a file with this name or path is read as a mesh: its extension is one of
/// `mesh_extensions`, in any case, perhaps followed by ".gz".
[[nodiscard]] bool is_mesh_name(const std::string& name);

struct MeshReadOptions {
    /// Makes warnings Error{defect}: wrong counts, truncation, corners that are not finite.
    bool strict = false;
    /// Reads bodies with these roles in 3MF and AMF files as solids. By default negative volumes are
    /// subtracted when their object is sliced, and other bodies are skipped; one warning counts them.
    MeshRoles include = {};
    /// Largest number of triangles, in the file or over all instances; more are Error{limit}. 0: as many as
    /// memory allows. They are counted while the file is read, before memory is allocated for them.
    std::uint64_t max_triangles = 0;
    /// Largest number of bytes in memory, of the file (decompressed) and of the meshes; more are
    /// Error{limit}. 0: three quarters of the available memory. Not counted are binary STL files of at least
    /// 64 KiB that are not compressed, files copied to a temporary file (see `read_mesh`), and data that is
    /// computed from a mesh afterwards.
    std::uint64_t max_memory = 0;
};

/// A mesh of a file as stored: in the file's unit, without placement.
struct MeshObject {
    std::string name;
    Mesh mesh;
};

/// A placed object. The placement gives millimetres; it includes the file's unit.
struct MeshInstance {
    std::size_t object = 0; ///< index into MeshFile::objects
    Transform placement = {};
    std::string name = {};
    bool support = false;   ///< the file marks it as support; only with MeshReadOptions::include
    bool negative = false;  ///< to be subtracted from the other instances of its `body`
    std::uint64_t body = 0; ///< the instances of one placed object have the same number
};

/// An object of a file or one of its volumes, even if it was not read.
struct MeshBody {
    std::string name = {};
    MeshRole role = MeshRole::part;
    std::uint64_t triangles = 0;
    bool left_out = false;
};

struct MeshFile {
    std::string path;
    std::string format; ///< "stl-binary", "stl-ascii", or the extension of another format, such as "3mf"
    /// The first solid's name or the header's text, if there is one: one line of valid UTF-8 with at most
    /// about 1000 bytes; other bytes are written as \xNN.
    std::string name;
    /// Meshes, which have finite corners only, and their placements. STL, OBJ, PLY and OFF files have one of
    /// each; 3MF and AMF files may have many instances, also several of one object.
    std::vector<MeshObject> objects;
    std::vector<MeshInstance> instances;
    /// All bodies that a 3MF or AMF file places.
    std::vector<MeshBody> bodies;
    /// Millimetres per unit of the file, if it states the unit.
    std::optional<double> unit_mm;
    std::uint64_t stored_triangles = 0;    ///< including dropped ones
    std::uint64_t nonfinite_triangles = 0; ///< dropped, because a corner is NaN or infinite
    std::uint64_t first_nonfinite = 0; ///< of binary STL: the index of the first of those, if there are any
    std::vector<std::string> warnings; ///< one line each: the irregularity and its treatment

    /// Returns instance i, placed.
    [[nodiscard]] Mesh placed(std::size_t i) const;
    /// Returns all instances, placed, as one mesh (see `joined`). O(1) for a file with one instance of a
    /// soup.
    [[nodiscard]] Mesh mesh(const Execution& execution = {}) const;
};

/// Reads a mesh file; its format is recognised by its content. "-" reads standard input. docs/formats.md
/// describes the accepted subset of each format.
///
/// The bytes are copied: the file may change during the call and is not needed afterwards. If it becomes
/// shorter while it is copied, that is Error{input}. If it would take more than a quarter of `max_memory`,
/// the copy is in an anonymous temporary file (in $TMPDIR, else /var/tmp), and a mesh of binary STL is a view
/// of it; Error{output} if the disk is full.
///
/// Corners of STL files have single precision in both forms: a number in an ASCII file is rounded once, to
/// the nearest, so the ASCII and the binary form of a part give the same slices, bit for bit. Stored normals
/// are ignored. All solids of an ASCII file are joined.
///
/// Accepted with a warning: a wrong or missing count, trailing bytes or text, a missing "endsolid", a
/// truncated last triangle, corners that are not finite (their triangles are dropped). For other defects, and
/// for a file without any usable triangle, throws Error{input} with file, byte or line, the text found and
/// the text expected.
///
/// O(bytes), parallel; the result does not depend on the number of threads.
[[nodiscard]] MeshFile read_mesh(const std::string& path, const MeshReadOptions& options = {},
                                 const Execution& execution = {});

/// Reads a copy of bytes in memory; `name` replaces the path in errors.
[[nodiscard]] MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name,
                                 const MeshReadOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
