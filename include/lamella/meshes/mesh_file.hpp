#pragma once

// Meshes of files, as the file describes them, without welding or repair.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/meshes/mesh_role.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct MeshReadOptions {
    /// Throws Error{defect} instead of a warning about wrong counts, truncation, or corners that are not
    /// finite.
    bool strict = false;
    /// Roles of bodies in 3MF and AMF files that are read as solids. By default negative volumes are
    /// subtracted when their object is sliced, and the other bodies that are not parts are skipped; one
    /// warning counts them.
    MeshRoles include = {};
    /// Largest number of triangles, in the file and over all instances; otherwise Error{limit} is thrown
    /// before they are allocated. 0: as many as memory allows.
    std::uint64_t max_triangles = 0;
    /// Largest number of bytes in memory that the decompressed file and the meshes may take; otherwise
    /// Error{limit} is thrown. 0: three quarters of the available memory. The following do not count:
    /// uncompressed binary STL files of at least 64 KiB, files copied to a temporary file (see `read_mesh`),
    /// and data computed from a mesh afterwards.
    std::uint64_t max_memory = 0;
    /// Bytes of `max_memory` that files read before still take.
    std::uint64_t held = 0;
    /// For `read_any`: the planes of a slice file that stay in memory. By default KeptPlanes::all.
    KeptPlanes kept = {};
};

/// A mesh of a file as stored: in the file's unit, without placement.
struct MeshObject {
    std::string name;
    Mesh mesh;
};

/// A placed object. The placement converts the file's units to millimetres.
struct MeshInstance {
    std::size_t object = 0; ///< index into MeshFile::objects
    Transform placement = {};
    std::string name = {};
    bool support = false;   ///< the file marks it as support; only with MeshReadOptions::include
    bool negative = false;  ///< to be subtracted from the other instances of its `body`
    std::uint64_t body = 0; ///< the instances of one placed object have the same number
};

/// An object of a file, or a volume of an object, even if it was not read.
struct MeshBody {
    std::string name = {};
    MeshRole role = MeshRole::part;
    std::uint64_t triangles = 0;
    bool left_out = false;
};

struct MeshFile {
    std::string path;
    std::string format; ///< "stl-binary", "stl-ascii", or the extension of another format, such as "3mf"
    /// The name of the first solid or the text of the header, if there is one, as a line of valid UTF-8 with
    /// at most about 1000 bytes (see `printable`).
    std::string name;
    /// Meshes, whose corners are all finite, and their placements. STL, OBJ, PLY and OFF files have one of
    /// each; 3MF and AMF files may have many instances, also several of one object.
    std::vector<MeshObject> objects;
    std::vector<MeshInstance> instances;
    /// All bodies that a 3MF or AMF file places.
    std::vector<MeshBody> bodies;
    /// Millimetres per unit of the file, if it states the unit.
    std::optional<double> unit_mm;
    std::uint64_t stored_triangles = 0;    ///< number in the file, with the dropped ones
    std::uint64_t nonfinite_triangles = 0; ///< dropped, because a corner is NaN or infinite
    std::uint64_t first_nonfinite = 0;     ///< index of the first dropped triangle, if any; binary STL only
    std::vector<std::string> warnings;     ///< one line each: the irregularity, and how the reader treated it

    /// Returns the mesh of instance i with its placement applied.
    [[nodiscard]] Mesh placed(std::size_t i) const;
    /// Returns all placed instances as one mesh (see `joined`). O(1) for a file with one instance of a soup.
    /// Throws Error{usage} if the file has negative volumes, because one mesh cannot express them:
    /// `load_plate` and `slice` of a plate subtract them.
    [[nodiscard]] Mesh mesh(const Execution& execution = {}) const;
};

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

} // namespace lamella
LAMELLA_API_END
