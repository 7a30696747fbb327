#pragma once

// Vertices and faces as OBJ, PLY and OFF files have them: gathered in pieces, joined, and made a mesh.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/executor.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"
#include "read/text_pieces.hpp"

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

/// A face of more than three corners. Until its real triangles are known it stands in the list of triangles
/// as the fan from its first corner.
struct FaceFan {
    std::uint64_t first_triangle;
    std::uint32_t triangles;
};

/// Faces, and the vertices that stand among them.
struct FacePiece : TextPiece {
    /// Names no vertex, as there are never so many.
    static constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

    std::vector<Point3> vertices; ///< also such that are not finite
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<FaceFan> polygons;
    /// Corners (3 t + k: corner k of triangle t) that count from the first vertex of this piece.
    std::vector<std::uint64_t> relative;
    Occurrences thin_faces;     ///< of fewer than three corners
    Occurrences free_form;      ///< curves and surfaces that are not made of faces
    std::size_t name = nowhere; ///< where that of the first object stands
    std::size_t rest = nowhere; ///< where more follows the last row that was asked for

    /// Adds the corners of a face that begins at `offset`.
    void add_face(const std::vector<std::uint32_t>& corners, std::size_t offset);
};

/// Triangles that share two corners each with the one before.
class TriangleStrip {
  public:
    void restart() noexcept { corners_ = 0; }
    /// The triangle that ends with this corner; none where the strip has just begun, and none that uses a
    /// corner twice, as where strips are sewn together. Every second one is turned, so that all face the same
    /// side.
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

/// Counts a piece as soon as it is parsed, before the next ones are.
void count_piece(const FacePiece& piece, ReadLimits& limits);
/// How many pieces are parsed ahead: some for each thread, however many there are.
[[nodiscard]] inline std::size_t face_pieces_ahead(const Executor& executor) noexcept {
    return std::max<std::size_t>(32, std::size_t{8} * executor.workers());
}

/// Takes back that it was counted.
void give_back_piece(const FacePiece& piece, ReadLimits& limits);

/// How a reader tells where triangle t came from, such as "line 7".
using TrianglePlace = std::function<std::string(std::uint64_t triangle)>;

/// Makes a mesh file of it: cuts the polygons into triangles, drops triangles with a corner that is not
/// finite (with a remark) and vertices that no triangle uses. Throws Error{input} where a face names a vertex
/// that is not there (`first_vertex` is the number of the first one in the file: 0 or 1), and where no
/// triangle is left.
[[nodiscard]] MeshFile make_mesh_file(FaceMesh faces, const std::string& source_name, unsigned first_vertex,
                                      const TrianglePlace& place, Remarks& remarks, Executor& executor);

/// Joins pieces, which it empties, and makes a mesh file of them.
[[nodiscard]] MeshFile make_mesh_file(const ByteSource& source, const PieceParser<FacePiece>& parser,
                                      std::vector<FacePiece>& pieces, unsigned first_vertex, Remarks& remarks,
                                      Executor& executor);

} // namespace lamella
