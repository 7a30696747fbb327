#pragma once

// Counts the defects of a mesh. Nothing is repaired.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

struct Inspection {
    Box3 box;              ///< bounding box of all vertices
    double volume_mm3 = 0; ///< signed; meaningful when `closed()`
    double area_mm2 = 0;   ///< area of all triangles
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;

    /// Edges with one triangle.
    std::uint64_t boundary_edges = 0;
    /// Edges with more than two triangles.
    std::uint64_t nonmanifold_edges = 0;
    /// Edges that triangles use more often in one direction than in the other. Boundary edges do not count.
    std::uint64_t orientation_conflicts = 0;
    /// Triangles beyond the first with the same three vertices, in either orientation.
    std::uint64_t duplicate_triangles = 0;
    /// Triangles that use a vertex twice: lines or points. They have no edges and belong to no shell.
    std::uint64_t degenerate_triangles = 0;
    /// Connected components: triangles connected by edges.
    std::uint64_t shells = 0;
    /// Closed shells of negative volume inside the material of others: correctly oriented cavities.
    std::uint64_t cavities = 0;
    /// Closed shells of negative volume that are not inside material: inside out.
    std::uint64_t inverted_shells = 0;

    /// Returns true if every edge is used equally often in both directions. Slices then have no open chains.
    [[nodiscard]] bool closed() const noexcept { return boundary_edges == 0 && orientation_conflicts == 0; }
    /// Returns true if `defect_kinds` finds nothing: all counts of defects are 0.
    [[nodiscard]] bool sound() const noexcept;
};

/// The words for a kind of defect in all reports.
struct DefectWords {
    std::string_view key;     ///< name of its count, here and in JSON
    std::string_view one;     ///< singular
    std::string_view many;    ///< plural
    std::string_view meaning; ///< explains the defect and its effect on slices
};

struct DefectKind {
    std::uint64_t Inspection::*count;
    bool spoils_contours; ///< contours stay open or run in the wrong direction
    DefectWords words;
};

/// All defects that an inspection counts.
inline constexpr std::array<DefectKind, 6> defect_kinds{
    {{&Inspection::boundary_edges,
      true,
      {"boundary_edges", "boundary edge", "boundary edges",
       "the surface has holes; contours stay open there"}},
     {&Inspection::nonmanifold_edges,
      false,
      {"nonmanifold_edges", "non-manifold edge", "non-manifold edges",
       "more than two triangles share an edge; contours part or touch there"}},
     {&Inspection::orientation_conflicts,
      true,
      {"orientation_conflicts", "orientation conflict", "orientation conflicts",
       "neighbouring triangles face opposite ways; contours stay open there"}},
     {&Inspection::duplicate_triangles,
      false,
      {"duplicate_triangles", "duplicate triangle", "duplicate triangles",
       "the same triangle more than once"}},
     {&Inspection::degenerate_triangles,
      false,
      {"degenerate_triangles", "degenerate triangle", "degenerate triangles",
       "two equal corners; left out of everything"}},
     {&Inspection::inverted_shells,
      true,
      {"inverted_shells", "inverted shell", "inverted shells",
       "inside out; contours run the wrong way round there"}}}};

/// Returns the words for the defect that this member of Inspection counts.
[[nodiscard]] constexpr const DefectWords& words_of(std::uint64_t Inspection::*count) {
    const auto* kind = defect_kinds.begin();
    while (kind->count != count)
        ++kind;
    return kind->words;
}

/// Returns a text such as "2 boundary edges, 1 inverted shell"; "" if the mesh is sound.
[[nodiscard]] std::string describe_defects(const Inspection& found);

inline bool Inspection::sound() const noexcept {
    return std::all_of(defect_kinds.begin(), defect_kinds.end(),
                       [this](const DefectKind& kind) { return this->*kind.count == 0; });
}

/// Counts the defects of a mesh. Degenerate triangles (equal corners) are counted and otherwise ignored, as
/// in slicing. Expected O(n) if few triangles lie above or below each shell; O(n^2) time for n nested shells,
/// but no more memory. Parallel where it pays; the result is the same for any number of threads.
[[nodiscard]] Inspection inspect(const IndexedMesh& mesh, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
