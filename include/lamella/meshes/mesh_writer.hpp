#pragma once

// Mesh writers: STL, PLY and OBJ.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

class AtomicFile;

/// Writes a binary STL file with computed normals, atomically: no reader ever sees an incomplete file. "-"
/// writes standard output. Placed corners are rounded to single precision. Throws Error{output}, also for
/// coordinates beyond the range of single precision, and Error{limit} for more than 2^32 - 1 triangles.
void write_stl(const std::string& path, const TriangleSoup& soup);

/// Writes a mesh, indexed or not, as a binary STL file. Returns a warning with the number of triangles that
/// lose their area by rounding. With `strict`, throws Error{defect} instead of a warning, and writes no file.
/// If `memory` is not null, the bytes replace its content, and no file is made; the path is then only a name
/// for errors. O(triangles).
std::vector<std::string> write_stl(const std::string& path, const Mesh& mesh, bool strict = false,
                                   std::string* memory = nullptr);

/// Writes a binary STL file like write_stl, but in chunks, for meshes that are larger than memory.
class StlWriter {
  public:
    /// Begins a file of `triangles` triangles. Throws the errors of write_stl. `memory` as for write_stl.
    StlWriter(const std::string& path, std::uint64_t triangles, std::string* memory = nullptr);
    ~StlWriter();
    StlWriter(const StlWriter&) = delete;
    StlWriter& operator=(const StlWriter&) = delete;

    void append(const TriangleSoup& soup);
    /// Completes the file, which then appears at its path. Throws Error{usage} if the number of triangles
    /// differs from the announced one.
    void finish();

  private:
    std::unique_ptr<AtomicFile> file_;
    std::uint64_t announced_;
    std::uint64_t written_ = 0;
};

/// Writes an ASCII STL file. Its numbers are the shortest ones that read back to the same corners. Atomicity,
/// "-" and errors as for write_stl.
void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name);

/// Writes a binary little-endian PLY file with the unchanged vertices and triangles. Coordinates have single
/// precision if it represents all of them exactly, and double precision otherwise. Atomicity, "-", `memory`
/// and errors as for write_stl.
void write_ply(const std::string& path, const IndexedMesh& mesh, std::string* memory = nullptr);

/// Writes an OBJ file with the unchanged vertices and triangles. Its numbers are the shortest ones that read
/// back to the same coordinates. Atomicity, "-", `memory` and errors as for write_stl.
void write_obj(const std::string& path, const IndexedMesh& mesh, const std::string& name,
               std::string* memory = nullptr);

} // namespace lamella
LAMELLA_API_END
