#pragma once

// Vertices and faces as OBJ, PLY and OFF files have them: gathered in pieces, joined, and made a mesh.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/executor.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"

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

/// What makes a piece of text unreadable.
struct TextFault {
    std::size_t offset;
    std::string expected;
};

/// Faces, and the vertices that stand among them.
struct FacePiece {
    static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
    /// Names no vertex, as there are never so many.
    static constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

    std::vector<Point3> vertices; ///< also such that are not finite
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<FaceFan> polygons;
    /// Corners (3 t + k: corner k of triangle t) that count from the first vertex of this piece.
    std::vector<std::uint64_t> relative;
    std::uint64_t thin_faces = 0; ///< of fewer than three corners
    std::size_t first_thin = nowhere;
    std::optional<TextFault> fault;

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

/// Counts a piece as soon as it is there, before the next ones are read.
void count_piece(const FacePiece& piece, ReadLimits& limits);
/// Takes back that it was counted.
void give_back_piece(const FacePiece& piece, ReadLimits& limits);

/// All pieces, in order. Empties them.
[[nodiscard]] FaceMesh join(std::vector<FacePiece>& pieces, Executor& executor);

/// How a reader tells where triangle t came from, such as "line 7".
using TrianglePlace = std::function<std::string(std::uint64_t triangle)>;

/// Makes a mesh file of it: cuts the polygons into triangles, drops triangles with a corner that is not
/// finite (with a remark) and vertices that no triangle uses. Throws Error{input} where a face names a vertex
/// that is not there (`first_vertex` is the number of the first one in the file: 0 or 1), and where no
/// triangle is left.
[[nodiscard]] MeshFile make_mesh_file(FaceMesh faces, const std::string& source_name, unsigned first_vertex,
                                      const TrianglePlace& place, Remarks& remarks, Executor& executor);

} // namespace lamella
