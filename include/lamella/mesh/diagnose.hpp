#pragma once

// Finds the defects of a mesh and their locations. Nothing is repaired.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/self_intersections.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The rim of a hole: boundary edges joined end to end, in the direction that they have in the missing
/// triangles. A loop passes no vertex twice: where holes touch, each has a loop of its own.
struct BoundaryLoop {
    std::vector<Point3> points; ///< the first point of a closed loop is not repeated at the end
    bool closed = true;         ///< false where a flipped triangle breaks the rim
    double length_mm = 0;
    /// Largest distance of a point of the loop from a line: the line through the loop's first point and the
    /// point farthest from the first point. At a T-junction (a vertex on an edge of a neighbour) this
    /// distance is within rounding errors.
    double width_mm = 0;
    Box3 box;

    [[nodiscard]] std::size_t edges() const noexcept { return closed ? points.size() : points.size() - 1; }
};

/// Kind of a shell, by its orientation and by the material around it.
enum class ShellKind {
    body,     ///< closed; the volume is positive, or 0 within rounding
    cavity,   ///< closed, of negative volume, inside the material of other shells
    inverted, ///< closed, of negative volume, but not inside material: inside out
    open,     ///< not closed
};

/// Returns "body", "cavity", "inverted" or "open".
[[nodiscard]] std::string_view shell_kind_name(ShellKind kind) noexcept;

/// A connected component: triangles connected by edges.
struct Shell {
    std::uint32_t first_triangle = 0;
    std::uint64_t triangles = 0; ///< degenerate triangles belong to no shell
    Box3 box;
    /// Signed volume, about the shell's first corner; meaningful for closed shells only.
    double volume_mm3 = 0;
    ShellKind kind = ShellKind::body;
    /// Another shell contains this shell if it winds around the centroid of this shell's largest triangle.
    /// `inside` is the containing shell of least volume; `depth` is the number of containing shells.
    std::optional<std::uint32_t> inside = {};
    std::uint32_t depth = 0;
};

using EdgeLocation = std::array<Point3, 2>;

inline constexpr DefectWords non_manifold_vertices{
    "nonmanifold_vertices", "non-manifold vertex", "non-manifold vertices",
    "parts of the surface touch in a point; no harm to contours"};

struct Diagnosis {
    Inspection counts;

    std::uint64_t boundary_loops = 0;
    /// Number of slits: closed loops no wider than the rounding of coordinates, where edges coincide without
    /// sharing vertices. `widest_slit_mm` is the width of the widest slit.
    std::uint64_t slits = 0;
    double widest_slit_mm = 0;
    double boundary_length_mm = 0;
    /// Vertices at which parts of the surface touch: the triangles at such a vertex are not all connected by
    /// edges that end there.
    std::uint64_t nonmanifold_vertices = 0;
    /// Pairs of duplicate triangles of opposite orientation. Each triangle is in at most one pair.
    std::uint64_t opposite_pairs = 0;

    // Locations: the first `keep` of each kind.
    std::vector<BoundaryLoop> loops;             ///< longest first
    std::vector<EdgeLocation> nonmanifold_edges; ///< ordered by vertex numbers
    std::vector<EdgeLocation> conflicting_edges; ///< ordered by vertex numbers
    std::vector<Point3> vertices;                ///< the non-manifold vertices, ordered by number
    /// Ordered by number; the first triangle of each group of duplicates is not listed.
    std::vector<std::uint32_t> duplicate_triangles;
    std::vector<std::uint32_t> degenerate_triangles;     ///< ordered by number
    std::vector<Shell> shells;                           ///< ordered by first triangle
    std::optional<SelfIntersections> self_intersections; ///< if requested; its parts are shells
};

struct DiagnosisOptions {
    /// Largest number of locations of each kind, shells included; the counts are complete.
    std::size_t keep = 16;
    bool self_intersections = false;

    static constexpr std::size_t keep_all = std::numeric_limits<std::size_t>::max();
};

/// Finds the defects of a mesh. Throws Error{limit} beyond 2^32 / 3 triangles. Expected O(n) if few triangles
/// lie above or below each shell; the search for self-intersections costs as much as
/// `find_self_intersections`. The result is the same for any number of threads.
[[nodiscard]] Diagnosis diagnose(const IndexedMesh& mesh, const DiagnosisOptions& options = {},
                                 const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
