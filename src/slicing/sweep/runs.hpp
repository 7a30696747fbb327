#pragma once

// Runs: contours over the planes that one walk serves. A sequence of nodes remains valid up to its first
// event: a node ends or changes to its other successor. All planes before the first event are a run, whose
// length is bounded.

#include "lamella/core/point.hpp"
#include "lamella/slicing/plan.hpp"

#include "slicing/sweep/columns.hpp"
#include "slicing/sweep/walk.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// One contour over the planes [begin, end).
struct Run {
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t size; ///< number of nodes
    bool closed;
    std::uint64_t nodes;   ///< offset of its nodes among those of all runs
    std::uint64_t rings;   ///< its ring on plane p is rings[this + p - begin]
    std::uint64_t columns; ///< offset of its edges in the column store, or not_kept
};

/// One contour on one plane.
struct Ring {
    Point2 first;           ///< the point at which it starts
    std::uint32_t start;    ///< index of that point after repeated points are dropped
    std::uint32_t count;    ///< number of points kept; 0 if it shrank to a point or a line
    std::uint64_t position; ///< offset in the layer's array
};

/// The runs of a task that are needed by later planes or by planes not yet written. Runs, their nodes and
/// their rings are stored in the order in which the runs were found.
class Runs {
  public:
    /// Must be called before the first plane of a task. Requires that no runs of the previous task are left.
    void begin_task(PlaneRange planes) {
        assert(runs_.empty() && nodes_.empty() && rings_.empty());
        planes_ = planes;
        ending_.assign(planes.size() + std::size_t{1}, 0);
    }

    void reserve_nodes(std::size_t nodes) { nodes_.reserve(nodes); }

    /// Adds a run from `plane` on, with rings not measured yet.
    Run& add(std::uint32_t plane, const NodeSequence& sequence) {
        assert(plane >= planes_.begin && plane < sequence.valid_until && sequence.valid_until <= planes_.end);
        assert(runs_.empty() || runs_.back().begin <= plane);
        const Run run{plane,
                      sequence.valid_until,
                      static_cast<std::uint32_t>(sequence.nodes.size()),
                      sequence.closed,
                      nodes_.size(),
                      rings_.size(),
                      ColumnStore::not_kept};
        nodes_.insert(nodes_.end(), sequence.nodes.begin(), sequence.nodes.end());
        rings_.resize(rings_.size() + (run.end - run.begin));
        ending_[run.end - planes_.begin] += run.size;
        return runs_.emplace_back(run);
    }

    [[nodiscard]] std::span<Run> all() noexcept { return runs_; }
    [[nodiscard]] std::span<const std::uint32_t> nodes(const Run& run) const noexcept {
        return std::span(nodes_).subspan(run.nodes, run.size);
    }
    /// Returns the rings of a run on some of its planes.
    [[nodiscard]] std::span<Ring> rings(const Run& run, PlaneRange planes) noexcept {
        assert(run.begin <= planes.begin && planes.begin <= planes.end && planes.end <= run.end);
        return std::span(rings_).subspan(index_of(run, planes.begin), planes.size());
    }

    /// Returns the index of a ring among those of all runs. It is valid until runs are forgotten.
    [[nodiscard]] static std::uint64_t index_of(const Run& run, std::uint32_t plane) noexcept {
        return run.rings + plane - run.begin;
    }
    [[nodiscard]] Ring& ring(std::uint64_t index) noexcept {
        assert(index < rings_.size());
        return rings_[index];
    }
    [[nodiscard]] const Run& run_of(std::uint64_t ring) const noexcept {
        const auto behind =
            std::upper_bound(runs_.begin(), runs_.end(), ring,
                             [](std::uint64_t index, const Run& run) { return index < run.rings; });
        assert(behind != runs_.begin());
        return *std::prev(behind);
    }

    /// Must be called when all runs that begin on a plane are known. Returns true if it is time to write and
    /// forget runs. This is when the ended runs hold many nodes, and at least as many as were alive when runs
    /// were last forgotten.
    [[nodiscard]] bool end_plane(std::uint32_t plane) noexcept {
        constexpr std::uint64_t enough = 1U << 15; // nodes
        stale_ += ending_[plane + 1 - planes_.begin];
        return stale_ >= enough && stale_ >= alive_then_;
    }

    /// Forgets the runs that end at or before `plane`, and moves the others and their columns in the store
    /// together. Earlier planes must not be accessed again.
    void forget_before(std::uint32_t plane, ColumnStore& store) {
        std::vector<Run> runs;
        std::vector<Ring> rings;
        std::uint64_t nodes = 0;
        store.release();
        for (const Run& run : runs_) {
            if (run.end <= plane)
                continue;
            Run kept = run;
            kept.begin = std::max(run.begin, plane);
            kept.nodes = nodes;
            const auto first = nodes_.begin() + static_cast<std::ptrdiff_t>(run.nodes);
            std::copy(first, first + run.size, nodes_.begin() + static_cast<std::ptrdiff_t>(nodes));
            nodes += run.size;
            if (run.columns != ColumnStore::not_kept)
                kept.columns = store.move_down(run.columns, run.size);
            kept.rings = rings.size();
            const auto ring = rings_.begin() + static_cast<std::ptrdiff_t>(run.rings);
            rings.insert(rings.end(), ring + (kept.begin - run.begin), ring + (run.end - run.begin));
            runs.push_back(kept);
        }
        runs_ = std::move(runs);
        rings_ = std::move(rings);
        nodes_.resize(nodes);
        alive_then_ = nodes;
        stale_ = 0;
    }

  private:
    PlaneRange planes_; // planes of the task
    std::vector<Run> runs_;
    std::vector<std::uint32_t> nodes_;
    std::vector<Ring> rings_;
    std::vector<std::uint64_t> ending_; ///< per plane of the task and after it: nodes of runs that end there
    std::uint64_t stale_ = 0;           ///< nodes of runs that have ended
    std::uint64_t alive_then_ = 0;      ///< nodes when runs were forgotten last
};

} // namespace lamella
