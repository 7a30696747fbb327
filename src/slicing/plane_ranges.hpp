#pragma once

// Ranges of planes that are sliced separately, because the memory of one machine is too small for all planes,
// or because several processes share the work.
//
//     count      the triangles that begin and end on each plane, in one pass, in chunks of any size
//     divide     the planes into ranges of equal work, or into ranges that fit into memory
//     find       the ranges that a triangle touches: the layers of a range depend only on such triangles
//     slice      each range alone: `slice_to` with its triangles, in any order, and its part of the plan
//
// The layers of all ranges are, bit for bit, the layers of the whole mesh on the whole plan.

#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "slicing/ranks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace lamella {

[[nodiscard]] Plan part_of(const Plan& plan, PlaneRange range);

/// Numbers of triangles that begin, end, or have their middle corner at each plane. The counts of a mesh are
/// the sums of the counts of its chunks, and do not depend on the order of triangles nor on the chunks.
class PlaneCounts {
  public:
    explicit PlaneCounts(std::size_t planes) : planes_(planes), counts_(3 * (planes + 1)) {}

    /// Counts a triangle with corners of these ranks, in ascending order.
    void add(std::uint32_t low, std::uint32_t middle, std::uint32_t high) noexcept {
        if (low == high)
            return;
        ++counts_[low];
        ++counts_[planes_ + 1 + high];
        counts_[2 * (planes_ + 1) + middle] += low < middle && middle < high ? 1 : 0;
    }

    /// Adds counts for the same plan.
    void add(const PlaneCounts& other) noexcept;

    [[nodiscard]] std::size_t planes() const noexcept { return planes_; }

    /// Returns all counts, to be summed element by element over processes (as MPI_Allreduce does): three
    /// numbers for each plane and three more.
    [[nodiscard]] std::span<std::uint64_t> numbers() noexcept { return counts_; }

    /// Number of triangles whose lowest plane is p.
    [[nodiscard]] std::uint64_t begins(std::size_t p) const noexcept { return counts_[p]; }
    /// Number of triangles whose uppermost plane is p - 1.
    [[nodiscard]] std::uint64_t ends(std::size_t p) const noexcept { return counts_[planes_ + 1 + p]; }
    /// Number of triangles whose middle corner lies between planes p - 1 and p, both of which cut them.
    [[nodiscard]] std::uint64_t turns(std::size_t p) const noexcept { return counts_[2 * (planes_ + 1) + p]; }

  private:
    friend PlaneCounts part_of(const PlaneCounts& counts, PlaneRange range);

    std::size_t planes_;
    std::vector<std::uint64_t> counts_;
};

/// Returns the counts on the planes of a range, which are the counts for that part of the plan.
[[nodiscard]] PlaneCounts part_of(const PlaneCounts& counts, PlaneRange range);

/// Counts triangles from any number of threads at once.
class PlaneCounter {
  public:
    explicit PlaneCounter(const Plan& plan) : ranks_(plan) {}

    /// Counts a mesh on the calling thread; the placement of a soup applies. Returns the planes from the
    /// first to the last one that cut any triangle. O(triangles).
    PlaneRange add(const Mesh& mesh) { return add(mesh, 0, mesh.size()); }
    PlaneRange add(const Mesh& mesh, std::uint64_t begin, std::uint64_t end);
    /// Returns the sum over all meshes that were added. Must not be called while a thread adds one.
    [[nodiscard]] PlaneCounts total() const;

  private:
    Ranks ranks_;
    std::mutex mutex_;
    std::vector<PlaneCounts> idle_; ///< counts that no thread uses at the moment
};

/// Counts the triangles of a mesh on all threads.
[[nodiscard]] PlaneCounts count_planes(const Mesh& mesh, const Plan& plan, const Execution& execution = {});

/// Size of the work of slicing a range, computed from the counts of all planes.
struct RangeNeeds {
    std::uint64_t triangles = 0;   ///< triangles that its planes cut
    std::uint64_t edges = 0;       ///< edges of these triangles that its planes cut; an edge shared by two
                                   ///< triangles counts twice
    std::uint64_t points = 0;      ///< points on all its planes together, if the mesh is closed
    std::uint64_t most_points = 0; ///< largest number of points on one of its planes
};

/// Computes the size of the work for any range.
class RangeSurvey {
  public:
    explicit RangeSurvey(const PlaneCounts& counts);

    [[nodiscard]] std::uint32_t planes() const noexcept {
        return static_cast<std::uint32_t>(before_.size() - 1);
    }
    /// Returns the number of triangles that plane p cuts: its number of points if the mesh is closed.
    [[nodiscard]] std::uint64_t points(std::uint32_t p) const noexcept {
        return before_[p + std::size_t{1}].points - before_[p].points;
    }
    [[nodiscard]] std::uint64_t triangles(PlaneRange range) const noexcept {
        return before_[range.end].begun - before_[range.begin].ended;
    }
    /// O(planes of the range).
    [[nodiscard]] RangeNeeds needs(PlaneRange range) const noexcept;
    /// Returns the same, given the largest number of points on one of its planes. O(1).
    [[nodiscard]] RangeNeeds needs(PlaneRange range, std::uint64_t most_points) const noexcept;
    /// Returns the estimated time of slicing the range, in units of the time of a point: its points, plus the
    /// costs of each of its triangles and planes. O(1).
    [[nodiscard]] std::uint64_t work(PlaneRange range) const noexcept;

  private:
    /// Sums over the planes before one plane.
    struct SumsBefore {
        std::uint64_t begun = 0;
        std::uint64_t ended = 0; ///< including those that end on the plane itself
        std::uint64_t rotated = 0;
        std::uint64_t points = 0;
    };

    std::vector<SumsBefore> before_; ///< one per plane, and one more
};

/// The smallest default bound of slice_to on points in flight, 112 MB. It does not depend on the threads:
/// memory that is used again, perhaps from the cache, costs less than fresh memory for each of them. This is
/// only a few layers of a million points each; a smaller bound costs time, because edges are laid out again
/// for each range of layers in flight.
inline constexpr std::uint64_t least_points_in_flight = (std::uint64_t{112} << 20) / sizeof(Point2);

/// Returns the default bound of slice_to. Layers of large meshes are large, too. If no more than a few of
/// them could be in flight, the tasks of many threads would be so short that walks took most of the time.
/// One point per triangle takes a tenth of the memory of the cut graph.
[[nodiscard]] constexpr std::uint64_t usual_points_in_flight(std::uint64_t triangles) noexcept {
    return std::max(least_points_in_flight, triangles);
}

/// The parameters of slicing a range that determine its memory.
struct RangeMemory {
    unsigned threads = 1;
    std::uint64_t points_in_flight = 0; ///< as passed to `slice_to`

    /// Returns an upper bound on the bytes that slicing a range takes: its triangles (36 bytes each), the cut
    /// graph with its indices, and the points in flight through a sink that formats them as text. Meshes
    /// whose triangles are in random order come close to this bound; other meshes take about half of it.
    [[nodiscard]] std::uint64_t bytes(const RangeNeeds& range) const noexcept;
};

/// Divides the planes into exactly `ranges` ranges so that the largest work of a range is as small as
/// possible. The result is the same on every machine. Throws Error{usage} if there are fewer planes than
/// ranges, or if `ranges` is 0.
[[nodiscard]] std::vector<PlaneRange> divide_evenly(const RangeSurvey& survey, std::uint32_t ranges);

/// Divides the planes into the fewest ranges that take at most `most_bytes` each, so that the largest work of
/// a range is as small as possible. Throws Error{limit} that reports height and size of a plane if this plane
/// alone takes more.
[[nodiscard]] std::vector<PlaneRange> divide_to_fit(const RangeSurvey& survey, const Plan& plan,
                                                    const RangeMemory& memory, std::uint64_t most_bytes);

/// Divides the planes into ranges of at most `most_points` points each; a plane with more points is a range
/// of its own.
[[nodiscard]] std::vector<PlaneRange> divide_by_points(const RangeSurvey& survey, std::uint64_t most_points);

/// Finds the ranges that triangles touch. Immutable; may be used from any number of threads at once.
class RangeFinder {
  public:
    /// Requires ranges in ascending order of both begin and end; they may overlap or have gaps between them.
    RangeFinder(const Plan& plan, std::span<const PlaneRange> ranges);

    /// The touched ranges [begin, end), as indices of ranges; none if begin == end.
    struct Touched {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    /// Writes one entry for each triangle to `touched`, whose previous content is lost. The placement of the
    /// soup applies.
    void find(const TriangleSoup& triangles, std::vector<Touched>& touched) const;

  private:
    Ranks ranks_;
    std::vector<std::uint32_t> first_;  ///< by a triangle's lowest plane: the first range that ends above it
    std::vector<std::uint32_t> behind_; ///< by the plane after its uppermost: the first range from there on
};

} // namespace lamella
