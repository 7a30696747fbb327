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
/// coordinates beyond the range of single precision, and Error{limit} beyond 2^32 - 1 triangles.
void write_stl(const std::string& path, const TriangleSoup& soup);

/// Writes a mesh of either kind. Returns a warning with the number of triangles that lose their area when
/// their corners are rounded; with `strict` throws Error{defect} instead, and writes no file. O(triangles).
std::vector<std::string> write_stl(const std::string& path, const Mesh& mesh, bool strict = false);

/// Writes a binary STL file like write_stl, but in chunks, for meshes that are larger than memory.
class StlWriter {
  public:
    /// Begins a file of `triangles` triangles. Throws the errors of write_stl.
    StlWriter(const std::string& path, std::uint64_t triangles);
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

/// Writes an ASCII STL file, with the shortest numbers that read back to the same corners. Atomicity, "-" and
/// errors as for write_stl.
void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name);

/// Writes a binary little-endian PLY file with the vertices and triangles as they are: in single precision if
/// it represents all of them exactly, else in double precision. Atomicity, "-" and errors as for write_stl.
void write_ply(const std::string& path, const IndexedMesh& mesh);

/// Writes an OBJ file with the vertices and triangles as they are, with the shortest numbers that read back
/// to the same coordinates. Atomicity, "-" and errors as for write_stl.
void write_obj(const std::string& path, const IndexedMesh& mesh, const std::string& name);

} // namespace lamella
LAMELLA_API_END
