#pragma once

// Reading meshes: what the file says, nothing welded, nothing repaired.

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

/// The extensions of mesh files, in lower case: "stl", "3mf"...
[[nodiscard]] std::vector<std::string_view> mesh_extensions();

/// Whether a file of this name, or path, goes for a mesh: one of `mesh_extensions` in any case, perhaps with
/// ".gz".
[[nodiscard]] bool is_mesh_name(const std::string& name);

struct MeshReadOptions {
    /// Makes Error{defect} of what is otherwise a warning: wrong counts, truncation, corners that are not
    /// finite.
    bool strict = false;
    /// Reads bodies that 3MF and AMF files mark as such as solids. Otherwise negative volumes are subtracted
    /// when their object is sliced, and all others are left out, which one warning counts.
    MeshRoles include = {};
    /// More triangles than this, in the file or over all instances, are Error{limit}; 0: as many as can be
    /// held. They are counted while a file is read, before there is memory for the rest.
    std::uint64_t max_triangles = 0;
    /// So are more bytes than this, of what a compressed file unpacks to and of the meshes; 0: three quarters
    /// of the memory there is. A binary STL file that is not packed does not count: one that would take more
    /// than a quarter of this is viewed where it lies (see `read_mesh`). Nor does what is made of a mesh
    /// afterwards.
    std::uint64_t max_memory = 0;
};

/// A mesh of a file, as it stands there: in the file's unit, placed nowhere.
struct MeshObject {
    std::string name;
    Mesh mesh;
};

/// An object put somewhere. The placement gives millimetres: the file's unit is in it.
struct MeshInstance {
    std::size_t object = 0; ///< index into MeshFile::objects
    Transform placement = {};
    std::string name = {};
    bool support = false;   ///< the file marks it so; with MeshReadOptions::include
    bool negative = false;  ///< it is to be subtracted from the others of its `body`
    std::uint64_t body = 0; ///< instances of one object as it is placed once have the same number
};

/// An object of a file or one of its volumes, whether it was read or not.
struct MeshBody {
    std::string name = {};
    MeshRole role = MeshRole::part;
    std::uint64_t triangles = 0;
    bool left_out = false;
};

struct MeshFile {
    std::string path;
    std::string format; ///< "stl-binary", "stl-ascii", or else the extension of its format, such as "3mf"
    /// The first solid's name or the header's text, where there is one: valid UTF-8 of one line and some 1000
    /// bytes at most; other bytes are written as \xNN.
    std::string name;
    /// Meshes with finite corners only, and where they stand. STL, OBJ, PLY and OFF files have one of each;
    /// 3MF and AMF files may have many instances, also several of one object.
    std::vector<MeshObject> objects;
    std::vector<MeshInstance> instances;
    /// Of 3MF and AMF files: all that they place.
    std::vector<MeshBody> bodies;
    /// Millimetres per unit of the file, where it states one.
    std::optional<double> unit_mm;
    std::uint64_t stored_triangles = 0;    ///< including those that were dropped
    std::uint64_t nonfinite_triangles = 0; ///< dropped, because a corner was NaN or infinite
    std::uint64_t first_nonfinite = 0; ///< of binary STL: the index of the first of those, if there are any
    std::vector<std::string> warnings; ///< one line each: what was odd and what was made of it

    /// Instance i, placed.
    [[nodiscard]] Mesh placed(std::size_t i) const;
    /// All instances, placed, as one mesh (see `joined`). O(1) for a file with one instance of a soup.
    [[nodiscard]] Mesh mesh(const Execution& execution = {}) const;
};

/// Reads a mesh file; its content says of which format it is. "-" reads standard input. Parallel; O(bytes);
/// the same result for any number of threads. docs/formats.md has what is accepted of each format.
///
/// The file is not needed once this has returned, and may change while it is read: the bytes are copied. One
/// that becomes shorter while it is copied is Error{input}. Of a file that would take more than a quarter of
/// `max_memory` the copy is in a temporary file without a name (in $TMPDIR, else /var/tmp), and a mesh of
/// binary STL is a view of that; Error{output} when there is no room for it.
///
/// Corners are single precision in both forms: a number in an ASCII file is rounded once, to the nearest, so
/// the ASCII and the binary form of a part give the same slices, bit for bit. Stored normals are ignored. All
/// solids of an ASCII file are taken together.
///
/// Accepted with a warning: a wrong or absent count, trailing bytes or text, a missing "endsolid", a
/// truncated last triangle, corners that are not finite (their triangles are dropped). Throws Error{input}
/// with file, byte or line, what was found and what was expected for anything else, also for a file without
/// any usable triangle.
[[nodiscard]] MeshFile read_mesh(const std::string& path, const MeshReadOptions& options = {},
                                 const Execution& execution = {});

/// The same from bytes in memory (copied); `name` stands for the path in errors.
[[nodiscard]] MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name,
                                 const MeshReadOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
