#pragma once

// Slicing: from a mesh and a plan to layers.

#include "lamella/contour/layer.hpp"
#include "lamella/core/commit.hpp"
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

/// Counts of the engines of the EECC paper (King, Rennie, Bennett 2021) while they sort intersections into
/// contours. They reproduce Tables 2, 3 and 4 and section 4.1 of the paper. An intersection is one triangle
/// on one plane; for `conventional` it is one segment of non-zero length.
struct MatchingCounts {
    /// Number of intersections by the case of their insertion.
    struct Cases {
        std::uint64_t new_list = 0; ///< no match: started a contour
        std::uint64_t front = 0;    ///< inserted before the first one of a contour
        std::uint64_t back = 0;     ///< appended to a contour
        std::uint64_t link = 0;     ///< inserted between two contours, which it joined
        std::uint64_t close = 0;    ///< appended to a contour, which it completed

        [[nodiscard]] std::uint64_t total() const noexcept { return new_list + front + back + link + close; }
        Cases& operator+=(const Cases& other) noexcept;
    };

    /// Number of searches through the lists of a plane (Table 2; "requires sorting" in Table 3).
    std::uint64_t searches = 0;
    /// Number of lists examined in all searches, each at both ends; for `conventional`, number of segments.
    std::uint64_t comparisons = 0;
    /// All intersections (Table 4).
    Cases inserted;
    /// Intersections placed by an edge link, without a search (the other columns of Table 3). Except for
    /// `conventional`, inserted.total() == by_edge_link.total() + searches.
    Cases by_edge_link;
    /// Size of the node that stores one intersection (section 4.1).
    std::uint64_t node_bytes = 0;
    /// Peak memory of nodes, lists and edges together, as allocated.
    std::uint64_t bytes = 0;

    /// Adds the counts of a second slicing: maximum of `bytes`, `node_bytes` of the second, sum of the rest.
    MatchingCounts& operator+=(const MatchingCounts& other) noexcept;
};

/// Sizes and times of one slicing.
struct SliceReport {
    double weld_seconds = 0;  ///< joining equal vertices of an indexed mesh, or welding a soup if needed
    double link_seconds = 0;  ///< sweep: ranks, cut graph; others: ranks, intersections, lists
    double slice_seconds = 0; ///< sweep: walk and points; others: reading the lists
    std::uint64_t layers = 0;
    std::uint64_t contours = 0;
    std::uint64_t open_chains = 0;
    std::uint64_t points = 0;
    std::optional<MatchingCounts> matching; ///< only from the engines of the paper

    /// Adds the report of a second slicing.
    SliceReport& operator+=(const SliceReport& other) noexcept;
};

/// Receives each layer as soon as it is sliced. If `prepare` or a commit throws, slicing stops and the
/// exception reaches the caller.
struct LayerSink {
    /// Called once for every layer; see Commit.
    std::function<Commit(Layer&& layer)> prepare;
};

/// Returns a sink that appends the layers to a stack in ascending z. The stack must outlive the sink.
[[nodiscard]] LayerSink appending_to(LayerStack& layers);

/// Called with ranges of triangles, [begin, end), while slicing reads them; each triangle of the mesh is
/// visited once. It is called from several threads at once. Since the triangles are then in the cache, a
/// visit costs less than a separate pass.
using TriangleVisitor = std::function<void(const Mesh& mesh, std::uint64_t begin, std::uint64_t end)>;

struct SliceJob; // input and output of an engine, which only engines know

/// One algorithm from mesh and plan to layers.
struct Engine {
    std::string_view name;    ///< the argument of `--engine`
    std::string_view summary; ///< one line for help texts
    std::string_view source;  ///< the publication it follows, or ""
    /// True if the engine needs an indexed mesh. It welds a soup first; pass the welded mesh if there is one.
    bool welds;
    void (*slice)(const SliceJob& job);
};

/// All engines; the first is the default.
[[nodiscard]] std::span<const Engine> engines() noexcept;

/// Returns the engine of this name. Throws Error{usage} that lists the known names.
[[nodiscard]] const Engine& engine(std::string_view name);

/// Options of `slice` and `slice_to`. Only the engine may change results.
struct SliceOptions {
    Execution execution = {};
    Engine engine = engines().front();
    /// Largest number of points handed to a sink and not yet released by its commits; 0: no bound. By
    /// default, one point per triangle, and at least 112 MB of points; for a plate of several bodies, 64 MB.
    /// A single larger layer is always permitted. `slice` holds all layers anyway and ignores it.
    std::optional<std::uint64_t> points_in_flight = {};
    TriangleVisitor visitor = {}; ///< receives the mesh; if it is indexed, with equal vertices joined
};

/// Returns one layer per plane of the plan, in order, each in normal form, empty where the plane misses the
/// mesh. On a closed, consistently oriented mesh every contour is a ring, for any coordinates. On other
/// meshes, contours that do not close are kept as open chains.
///
/// Throws Error{limit} for about 2^32 / 3 triangles or more, Error{cancelled}, the error of `check` for a
/// plan, and the exceptions of the progress function. The default engine takes O(triangles + points + c log
/// c) for c contours in a layer, and uses all threads; its result is, byte for byte, the same for any number
/// of threads and any order of the triangles.
[[nodiscard]] LayerStack slice(const Mesh& mesh, const Plan& plan, const SliceOptions& options = {});

/// Slices into a sink, which receives the layers that `slice` would return, each as soon as it is complete.
/// Layers that the sink has released take no memory.
SliceReport slice_to(const LayerSink& sink, const Mesh& mesh, const Plan& plan,
                     const SliceOptions& options = {});

/// Returns the area of the section at each plane of the plan, mm^2, computed directly from the triangles,
/// without contours. For closed, consistently oriented meshes this area equals the area of the layers of
/// every engine, except for rounding; `lamella verify --mesh` and the tests use it as an independent check.
/// O(triangles + points).
[[nodiscard]] std::vector<double> section_areas(const Mesh& mesh, const Plan& plan,
                                                const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
