#pragma once

// Mesh and plan in, layers out.

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// What the engines of the EECC paper (King, Rennie, Bennett 2021) count while they sort intersections into
/// contours; its Tables 2, 3 and 4 and its section 4.1 are made of these. An intersection is one triangle on
/// one plane; for `conventional` it is one segment that is longer than nothing.
struct MatchingCounts {
    /// What became of intersections when they were inserted.
    struct Cases {
        std::uint64_t new_list = 0; ///< no match: a contour of its own
        std::uint64_t front = 0;    ///< put before the first one of a contour
        std::uint64_t back = 0;     ///< put behind the last one of a contour
        std::uint64_t link = 0;     ///< put between two contours, which it made one
        std::uint64_t close = 0;    ///< put behind the last one of a contour that it completed

        [[nodiscard]] std::uint64_t total() const noexcept { return new_list + front + back + link + close; }
        Cases& operator+=(const Cases& other) noexcept;
    };

    /// How often the lists of a plane were gone through for a match (Table 2; "requires sorting" in Table 3).
    std::uint64_t searches = 0;
    /// How many lists all searches together looked at, each for a match with its first and its last
    /// intersection; for `conventional`, how many segments.
    std::uint64_t comparisons = 0;
    /// All intersections (Table 4).
    Cases inserted;
    /// Those among them that were placed by an edge link, without a search (the other columns of Table 3).
    /// inserted.total() == by_edge_link.total() + searches, but for `conventional`.
    Cases by_edge_link;
    /// Size of the node of one intersection: what section 4.1 counts.
    std::uint64_t node_bytes = 0;
    /// The most memory that nodes, lists and edges together took, as allocated.
    std::uint64_t bytes = 0;

    /// Of two runs, one after the other: the larger `bytes`, the sum of all else.
    MatchingCounts& operator+=(const MatchingCounts& other) noexcept;
};

/// What was sliced and how long it took; the statistics of the program are made from it.
struct SliceReport {
    double weld_seconds = 0;  ///< joining vertices; and in engines that need an indexed mesh, welding a soup
    double link_seconds = 0;  ///< sweep: ranks and cut graph; the paper's: ranks, intersections and lists
    double slice_seconds = 0; ///< sweep: walk and points; the paper's: reading the lists off
    std::uint64_t layers = 0;
    std::uint64_t contours = 0;
    std::uint64_t open_chains = 0;
    std::uint64_t points = 0;
    std::optional<MatchingCounts> matching; ///< of the engines of the paper

    /// Of two runs, one after the other.
    SliceReport& operator+=(const SliceReport& other) noexcept;
};

/// Receives layers while slicing goes on. It is called once for every layer, from several threads at once and
/// in any order: the place for work that can run in parallel, such as formatting. The function it returns (or
/// an empty one) is called later, one at a time and in ascending z: the place for what must be in order, such
/// as writing. Either may throw: slicing stops and the exception reaches the caller.
using LayerSink = std::function<std::function<void()>(Layer&&)>;

/// Sees each triangle of a mesh once, while slicing passes over them: the triangles [begin, end), called from
/// several threads at once. A look at triangles that are in the cache costs less than a pass of its own.
using TriangleVisitor = std::function<void(const Mesh& mesh, std::uint64_t begin, std::uint64_t end)>;

/// What an engine is given.
struct SliceJob {
    const Mesh& mesh;
    const Plan& plan;
    const LayerSink& sink;
    const Execution& execution;
    /// How many points may be under way between the engine and the sink's last word on them; 0: any number.
    std::uint64_t points_in_flight;
    SliceReport& report;
    /// Null where nobody wants to see triangles. Engines that weld have no part in it.
    const TriangleVisitor* visitor = nullptr;
};

/// One algorithm from mesh and plan to layers.
struct Engine {
    std::string_view name;    ///< as in `--engine`
    std::string_view summary; ///< one line for help texts
    std::string_view source;  ///< the publication it follows, or ""
    /// It works on an indexed mesh and welds a soup first: who has welded already gives it that mesh.
    bool welds;
    void (*slice)(const SliceJob& job);
};

/// All engines; the first is the default.
[[nodiscard]] std::span<const Engine> engines() noexcept;

/// Throws Error{usage} that lists the names there are.
[[nodiscard]] const Engine& engine(std::string_view name);

/// Slices into memory: one layer per plane of the plan, in order, each in normal form, empty where the plane
/// misses the mesh. On a closed, consistently oriented mesh every contour is a ring, whatever the
/// coordinates. Elsewhere what cannot be closed is kept as open chains.
///
/// Default engine: O(triangles + points + c log c) for c contours in a layer, on all threads; the same bytes
/// for any number of threads and any order of the triangles. Throws Error{limit} beyond 2^32 / 3 triangles,
/// Error{cancelled}, and what the progress function throws.
/// `visitor`, where there is one, sees the mesh with joined vertices.
[[nodiscard]] LayerStack slice(const Mesh& mesh, const Plan& plan, const Execution& execution = {},
                               SliceReport* report = nullptr, const Engine& engine = engines().front(),
                               const TriangleVisitor& visitor = {});

/// Slices into a sink: the same layers, each handed over when it is done, with a bounded number of points in
/// flight (some 56 MB per thread, 112 MB at least, or two layers per thread where those are more). Layers
/// that the sink has let go of take no memory. `points_in_flight` overrides this bound; 0 keeps it.
void slice_to(const LayerSink& sink, const Mesh& mesh, const Plan& plan, const Execution& execution = {},
              SliceReport* report = nullptr, const Engine& engine = engines().front(),
              std::uint64_t points_in_flight = 0, const TriangleVisitor& visitor = {});

/// The area of the section at each plane of the plan, in mm^2, straight from the triangles: no linking, no
/// contours. For closed meshes it equals the area of the layers, whichever engine made them: the check that
/// `lamella verify --mesh` and the tests rest on. O(triangles + points).
[[nodiscard]] std::vector<double> section_areas(const Mesh& mesh, const Plan& plan,
                                                const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
