#pragma once

// Parses vertices and faces of OBJ, PLY and OFF files in chunks, joins them, and makes a mesh of them.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "core/executor.hpp"
#include "meshes/remarks.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lamella {

/// A face of more than three corners. Until it is triangulated, the list of triangles contains the fan from
/// its first corner.
struct FaceFan {
    std::uint64_t first_triangle;
    std::uint32_t triangles;
};

/// The faces and vertices of a chunk of text.
struct FaceChunk : TextChunk {
    /// Stands for an invalid index.
    static constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

    std::vector<Point3> vertices; ///< including those that are not finite
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<FaceFan> polygons;
    /// Corners whose indices are relative to the first vertex of this chunk; corner k of triangle t is 3 t +
    /// k.
    std::vector<std::uint64_t> relative;
    Occurrences thin_faces;     ///< with fewer than three corners
    Occurrences free_form;      ///< curves and surfaces that do not consist of faces
    std::size_t name = nowhere; ///< offset of the name of the first object
    std::size_t rest = nowhere; ///< offset of text after the last row requested

    /// Adds the face with these corners that begins at `offset`.
    void add_face(const std::vector<std::uint32_t>& corners, std::size_t offset);
};

/// A strip of triangles, each of which shares two corners with the one before.
class TriangleStrip {
  public:
    void restart() noexcept { corners_ = 0; }
    /// Returns the triangle that ends with this corner. Returns nullopt at the beginning of the strip, and
    /// for a triangle that uses a corner twice, as where strips are joined. Every second triangle is flipped,
    /// so that all have the same orientation.
    [[nodiscard]] std::optional<std::array<std::uint32_t, 3>> add(std::uint32_t corner) noexcept;

  private:
    std::uint64_t corners_ = 0;
    std::uint32_t last_but_one_ = 0;
    std::uint32_t last_ = 0;
};

struct FaceMesh {
    IndexedMesh mesh;
    std::vector<FaceFan> polygons;
};

/// Counts a chunk in the limits. Must be called as soon as the chunk is parsed, before the next ones are.
void count_chunk(const FaceChunk& chunk, ReadLimits& limits);
/// Returns the number of chunks to parse ahead, several for each thread.
[[nodiscard]] inline std::size_t face_chunks_ahead(const Executor& executor) noexcept {
    return std::max<std::size_t>(32, std::size_t{8} * executor.workers());
}

/// Reverts count_chunk.
void give_back_chunk(const FaceChunk& chunk, ReadLimits& limits);

/// Returns the position of a triangle in the file, such as "line 7".
using TrianglePosition = std::function<std::string(std::uint64_t triangle)>;

/// Makes a mesh file of faces. Triangulates the polygons, and drops triangles with a corner that is not
/// finite (with a remark) and vertices that no triangle uses. `first_vertex`, 0 or 1, is the number of the
/// file's first vertex. Throws Error{input} if a face refers to a vertex that does not exist, or if no
/// triangle is left.
[[nodiscard]] MeshFile make_mesh_file(FaceMesh faces, const std::string& source_name, unsigned first_vertex,
                                      const TrianglePosition& location, Remarks& remarks, Executor& executor);

/// Joins chunks, which it empties, and makes them into a mesh file.
[[nodiscard]] MeshFile make_mesh_file(const ByteSource& source, const ChunkParser<FaceChunk>& parser,
                                      std::vector<FaceChunk>& chunks, unsigned first_vertex, Remarks& remarks,
                                      Executor& executor);

} // namespace lamella
