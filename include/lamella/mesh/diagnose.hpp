#pragma once

// What is wrong with a mesh, and where. Nothing is repaired.

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

/// The rim of a hole: boundary edges joined end to end, in the direction in which the missing triangles would
/// run through them. It passes no vertex twice: where holes touch, each has a loop of its own.
struct BoundaryLoop {
    std::vector<Point3> points; ///< of a closed loop the first one is not repeated at the end
    bool closed = true;         ///< false where a flipped triangle breaks the rim
    double length_mm = 0;
    /// The largest distance of a point from the line through the first one and the farthest from that:
    /// nothing but rounding where a vertex lies on an edge of a neighbour (a T-junction).
    double width_mm = 0;
    Box3 box;

    [[nodiscard]] std::size_t edges() const noexcept { return closed ? points.size() : points.size() - 1; }
};

/// What a shell is by its orientation and its place.
enum class ShellKind {
    body,     ///< closed, of positive volume, or of none but for rounding
    cavity,   ///< closed, of negative volume, in the material of others
    inverted, ///< closed, of negative volume, but not in material: inside out
    open,     ///< not closed
};

/// "body", "cavity", "inverted", "open".
[[nodiscard]] std::string_view shell_kind_name(ShellKind kind) noexcept;

/// A part of a mesh connected over edges.
struct Shell {
    std::uint32_t first_triangle = 0;
    std::uint64_t triangles = 0; ///< degenerate ones belong to no shell
    Box3 box;
    double volume_mm3 = 0; ///< signed; measured from its first corner, so meaningful for closed shells
    ShellKind kind = ShellKind::body;
    /// Shells that it lies in: that wind around the middle of its largest triangle. The one of them with the
    /// least volume, and how many.
    std::optional<std::uint32_t> inside = {};
    std::uint32_t depth = 0;
};

using EdgePlace = std::array<Point3, 2>;

inline constexpr DefectWords crowded_vertices{"nonmanifold_vertices", "crowded vertex", "crowded vertices",
                                              "parts of the surface touch in a point; no harm to contours"};

struct Diagnosis {
    Inspection counts;

    std::uint64_t boundary_loops = 0;
    /// Those of them that are closed and no wider than the rounding of coordinates: edges that lie on one
    /// another without sharing their vertices. And the widest.
    std::uint64_t slits = 0;
    double widest_slit_mm = 0;
    double boundary_length_mm = 0;
    /// Vertices at which parts of the surface touch: the triangles there are not all connected over edges
    /// that end there.
    std::uint64_t nonmanifold_vertices = 0;
    /// Pairs among the duplicate triangles that run opposite ways. (Each triangle is in one pair at most.)
    std::uint64_t opposite_pairs = 0;

    // Places: the first `keep` of each kind.
    std::vector<BoundaryLoop> loops;                     ///< the longest first
    std::vector<EdgePlace> nonmanifold_edges;            ///< by vertex numbers
    std::vector<EdgePlace> conflicting_edges;            ///< by vertex numbers
    std::vector<Point3> vertices;                        ///< the non-manifold ones, by number
    std::vector<std::uint32_t> duplicate_triangles;      ///< by number, the first of its kind not among them
    std::vector<std::uint32_t> degenerate_triangles;     ///< by number
    std::vector<Shell> shells;                           ///< by first triangle
    std::optional<SelfIntersections> self_intersections; ///< where asked for; its parts are shells
};

struct DiagnosisOptions {
    std::size_t keep = 16; ///< places of each kind, shells included; the counts are complete
    bool self_intersections = false;

    static constexpr std::size_t keep_all = std::numeric_limits<std::size_t>::max();
};

/// Finds the defects of a mesh. Expected O(n), for shells that few triangles lie above or below; self-
/// intersections cost what `find_self_intersections` says. The same result for any number of threads. Throws
/// Error{limit} beyond 2^32 / 3 triangles.
[[nodiscard]] Diagnosis diagnose(const IndexedMesh& mesh, const DiagnosisOptions& options = {},
                                 const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
