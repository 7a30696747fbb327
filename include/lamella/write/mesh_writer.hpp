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
/// coordinates beyond single precision, and Error{limit} beyond 2^32 - 1 triangles.
void write_stl(const std::string& path, const TriangleSoup& soup);

/// Does the same for any mesh. Returns a warning with the number of triangles that lose their area when their
/// corners are rounded; with `strict` this is Error{defect} instead, and no file is written. O(triangles).
std::vector<std::string> write_stl(const std::string& path, const Mesh& mesh, bool strict = false);

/// Writes the same file in chunks, for bodies that are larger than memory.
class StlWriter {
  public:
    /// Begins a file of `triangles` triangles. Errors as above.
    StlWriter(const std::string& path, std::uint64_t triangles);
    ~StlWriter();
    StlWriter(const StlWriter&) = delete;
    StlWriter& operator=(const StlWriter&) = delete;

    void append(const TriangleSoup& soup);
    /// Gives the file its name. Throws Error{usage} if there were more or fewer triangles than announced.
    void finish();

  private:
    std::unique_ptr<AtomicFile> file_;
    std::uint64_t announced_;
    std::uint64_t written_ = 0;
};

/// Writes the same as ASCII STL, with the shortest numbers that read back to the same corners.
void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name);

/// Writes a binary little-endian PLY file with the vertices and triangles as they are: in single precision if
/// it holds all of them exactly, else in double. Atomicity, "-" and errors as above.
void write_ply(const std::string& path, const IndexedMesh& mesh);

/// Writes an OBJ file with the vertices and triangles as they are, with the shortest numbers that read back
/// to the same coordinates. Atomicity, "-" and errors as above.
void write_obj(const std::string& path, const IndexedMesh& mesh, const std::string& name);

} // namespace lamella
LAMELLA_API_END
