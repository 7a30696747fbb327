#pragma once

// Slabs: ranges of planes that are sliced on their own, because one memory or one machine is not enough for
// all.
//
//     count      what the triangles bring to each plane: one pass over them, in any number of shares
//     divide     the planes into slabs of equal work, or into slabs that fit a memory
//     find       which slabs a triangle touches: a slab's layers need those triangles and no others
//     slice      each slab alone: `slice_to` with its triangles, in any order, and its part of the plan
//
// Put together, the layers are those of the whole mesh on the whole plan, bit for bit.

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

/// The plan of a slab.
[[nodiscard]] Plan part_of(const Plan& plan, PlaneRange slab);

/// How many triangles begin, turn and end on each plane. Counts of shares of a mesh are added up; those of
/// the whole do not depend on the order of the triangles nor on how they were shared out.
class PlaneCounts {
  public:
    explicit PlaneCounts(std::size_t planes) : planes_(planes), counts_(3 * (planes + 1)) {}

    /// A triangle with corners of these ranks (the number of planes below a corner), in ascending order.
    void add(std::uint32_t low, std::uint32_t middle, std::uint32_t high) noexcept {
        if (low == high)
            return;
        ++counts_[low];
        ++counts_[planes_ + 1 + high];
        counts_[2 * (planes_ + 1) + middle] += low < middle && middle < high ? 1 : 0;
    }

    /// Of the same plan.
    void add(const PlaneCounts& other) noexcept;

    [[nodiscard]] std::size_t planes() const noexcept { return planes_; }

    /// Everything there is, to be added up element by element where shares meet (as MPI_Allreduce does):
    /// three numbers for each plane and one more.
    [[nodiscard]] std::span<std::uint64_t> numbers() noexcept { return counts_; }

    /// Triangles that begin on plane p: their lowest corner lies below it and above the plane before.
    [[nodiscard]] std::uint64_t begins(std::size_t p) const noexcept { return counts_[p]; }
    /// Triangles whose uppermost plane is p - 1.
    [[nodiscard]] std::uint64_t ends(std::size_t p) const noexcept { return counts_[planes_ + 1 + p]; }
    /// Triangles whose middle corner lies between planes p - 1 and p, both of which cut them.
    [[nodiscard]] std::uint64_t turns(std::size_t p) const noexcept { return counts_[2 * (planes_ + 1) + p]; }

  private:
    friend PlaneCounts part_of(const PlaneCounts& counts, PlaneRange slab);

    std::size_t planes_;
    std::vector<std::uint64_t> counts_;
};

/// The counts on the planes of a slab: those of `part_of` its plan.
[[nodiscard]] PlaneCounts part_of(const PlaneCounts& counts, PlaneRange slab);

/// Counts triangles from any number of threads at once.
class PlaneCounter {
  public:
    explicit PlaneCounter(const Plan& plan) : ranks_(plan) {}

    /// On the calling thread, O(triangles); the placement of a soup counts. Returns the planes from the first
    /// one that cuts any of them to the last one.
    PlaneRange add(const Mesh& mesh) { return add(mesh, 0, mesh.size()); }
    /// The triangles [begin, end) of it.
    PlaneRange add(const Mesh& mesh, std::uint64_t begin, std::uint64_t end);
    /// Of all that was added; while nobody adds any.
    [[nodiscard]] PlaneCounts total() const;

  private:
    Ranks ranks_;
    std::mutex mutex_;
    std::vector<PlaneCounts> idle_; ///< nobody counts on them; as many as ever counted at the same time
};

/// The same for a mesh in memory, on all threads.
[[nodiscard]] PlaneCounts count_planes(const Mesh& mesh, const Plan& plan, const Execution& execution = {});

/// What a slab asks for, from the counts of all planes.
struct SlabNeeds {
    std::uint64_t triangles = 0;   ///< that a plane of it cuts
    std::uint64_t edges = 0;       ///< their edges that a plane of it cuts: one that two share counts twice
    std::uint64_t points = 0;      ///< on all its planes together, where the mesh is closed
    std::uint64_t most_points = 0; ///< on one of them
};

/// Answers for any slab.
class SlabSurvey {
  public:
    explicit SlabSurvey(const PlaneCounts& counts);

    [[nodiscard]] std::uint32_t planes() const noexcept {
        return static_cast<std::uint32_t>(before_.size() - 1);
    }
    /// Triangles that plane p cuts, which is the number of its points where the mesh is closed.
    [[nodiscard]] std::uint64_t points(std::uint32_t p) const noexcept {
        return before_[p + std::size_t{1}].points - before_[p].points;
    }
    [[nodiscard]] std::uint64_t triangles(PlaneRange slab) const noexcept {
        return before_[slab.end].begun - before_[slab.begin].ended;
    }
    /// O(planes of the slab)
    [[nodiscard]] SlabNeeds needs(PlaneRange slab) const noexcept;
    /// O(1), where the most points on one of its planes are known.
    [[nodiscard]] SlabNeeds needs(PlaneRange slab, std::uint64_t most_points) const noexcept;
    /// O(1). The time that slicing the slab takes, in the time of a point: its points, and what each of its
    /// triangles and planes costs besides.
    [[nodiscard]] std::uint64_t work(PlaneRange slab) const noexcept;

  private:
    /// Sums over the planes before one.
    struct SumsBefore {
        std::uint64_t begun = 0;
        std::uint64_t ended = 0; ///< those that have left the plane itself, too
        std::uint64_t turned = 0;
        std::uint64_t points = 0;
    };

    std::vector<SumsBefore> before_; ///< by plane, and one more
};

/// How many points slice_to has on their way where nobody says: 56 MB for each thread, and 112 MB at least.
/// Of layers of a million points each that is a handful, and fewer cost time: their edges are laid out anew
/// for each group of layers on its way.
[[nodiscard]] constexpr std::uint64_t usual_points_in_flight(unsigned threads) noexcept {
    return (std::uint64_t{56} << 20) / sizeof(Point2) * std::max(threads, 2U);
}

/// How a slab is sliced, as far as its memory depends on it.
struct SlabMemory {
    unsigned threads = 1;
    bool placed = false; ///< its soup has a placement: coordinates are kept in double precision
    std::uint64_t points_in_flight = 0; ///< as handed to `slice_to`

    /// Bytes that slicing a slab takes at most: its triangles (36 bytes each), the cut graph and what belongs
    /// to it, and points on their way through a sink that formats them as text. For a mesh whose triangles
    /// are in no order; others take about half.
    [[nodiscard]] std::uint64_t bytes(const SlabNeeds& slab) const noexcept;
};

/// Exactly `slabs` of them, with the largest work as small as possible. The same on every machine. Throws
/// Error{usage} when there are fewer planes, or none are asked for.
[[nodiscard]] std::vector<PlaneRange> divide_evenly(const SlabSurvey& survey, std::uint32_t slabs);

/// Fewest slabs that take no more than `most_bytes` each; among those, the division with the smallest largest
/// work. Throws Error{limit} when a single plane takes more, saying where it lies and how much it takes.
[[nodiscard]] std::vector<PlaneRange> divide_to_fit(const SlabSurvey& survey, const Plan& plan,
                                                    const SlabMemory& memory, std::uint64_t most_bytes);

/// Slabs filled one after the other with planes of `most_points` together, or with a single plane of more.
[[nodiscard]] std::vector<PlaneRange> divide_by_points(const SlabSurvey& survey, std::uint64_t most_points);

/// Tells which slabs triangles touch. Immutable; for any number of threads at once.
class SlabFinder {
  public:
    /// Slabs of the plan, none of which begins or ends below the one before; they may overlap or have gaps
    /// between them.
    SlabFinder(const Plan& plan, std::span<const PlaneRange> slabs);

    /// Slabs [begin, end), by their positions in the division; none where begin == end.
    struct Touched {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    /// One entry for each triangle; its content before does not matter. The soup's placement counts.
    void find(const TriangleSoup& triangles, std::vector<Touched>& touched) const;

  private:
    Ranks ranks_;
    std::vector<std::uint32_t> first_;  ///< by a triangle's lowest plane: the first slab that ends above it
    std::vector<std::uint32_t> behind_; ///< by the plane behind its uppermost: the first slab from there on
};

} // namespace lamella
