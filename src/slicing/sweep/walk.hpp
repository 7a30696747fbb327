#pragma once

// Reads contours from the cut graph: from a node that begins on a plane, follows `next` until it reaches the
// start. If no node of a contour begins on a plane, the contour continues a contour of the plane below and is
// not walked again, except once every `longest_run` planes, from any one of its nodes.

#include "lamella/slicing/plan.hpp"

#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/visit_marks.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// The nodes of a contour, in the order in which the contour visits them. On all planes from the walked plane
/// to the plane before `valid_until`, the nodes are the same and link to one another.
struct NodeSequence {
    std::span<const std::uint32_t> nodes;
    std::uint32_t valid_until;
    bool closed;
};

/// The walks of one worker, over the planes of one task after the other.
template <class Ends>
class Walk {
  public:
    /// Requires marks of all nodes, initially 0, which the walks of all workers share.
    Walk(const LocatedGraph<Ends>& graph, const SharedMarks& marks)
        : graph_(graph), marks_(marks, graph.nodes) {}

    /// Must be called before the first plane of a task. Requires tasks in ascending order, and in `carried`
    /// all nodes that reach into the task from below; it must live until the first plane is walked.
    void begin_task(PlaneRange planes, std::span<const std::uint32_t> carried) {
        assert(planes.begin < planes.end && planes.begin >= planes_.end);
        planes_ = planes;
        carried_ = carried;
        marks_.begin_task(planes.begin, carried);
        restarts_.assign(planes.size(), {});
    }

    /// Calls found(NodeSequence) once for every contour on the plane that visits a node in `starts`, or a
    /// node of a sequence that ended just below, or on the first plane of the task a carried node. Omits
    /// contours that were found on an earlier plane and are still valid. Requires planes in ascending order
    /// within a task.
    template <class Found>
    void walk(std::uint32_t plane, std::span<const std::uint32_t> starts, const Found& found) {
        assert(plane >= planes_.begin && plane < planes_.end);
        assert(segments_.empty() && pending_.empty());
        walk_from(plane, starts, found);
        walk_from(plane, std::exchange(carried_, {}), found);
        const std::vector<std::uint32_t> again = std::move(restarts_[plane - planes_.begin]);
        walk_from(plane, again, found);
        if (!segments_.empty())
            join_segments(plane, found);
    }

    /// Marks nodes whose contour is known on the planes before `end`, which then need no walk over them. May
    /// be called from any number of threads at once, for different nodes, but not during a walk.
    void skip(std::span<const std::uint32_t> nodes, std::uint32_t end) {
        for (const std::uint32_t node : nodes) {
            assert(!marks_.marked(node, end)); // no earlier walk knows more planes
            marks_.mark(node, end);
        }
    }

  private:
    /// The nodes from the start of one walk to the start of another walk, or to the end of the mesh.
    struct Segment {
        std::uint32_t start; ///< its first node
        std::uint32_t next;  ///< first node of the following segment, later its index; no_node if there is
                             ///< none
        std::uint64_t begin;
        std::uint64_t end;
        std::uint32_t valid_until;
    };

    struct Walker {
        std::uint32_t node;
        std::uint32_t start;
        std::uint32_t valid_until;
        std::uint64_t candidate; ///< the next candidate to examine
        std::uint64_t candidates_end;
        std::vector<std::uint32_t> nodes; ///< room for more than has been visited
        std::size_t visited = 0;

        [[nodiscard]] std::span<const std::uint32_t> sequence() const noexcept {
            return {nodes.data(), visited};
        }

        /// Does what push_back does, but inlined: its calls were 2.5 % of the instructions for a lattice.
        void add(std::uint32_t id) {
            if (visited == nodes.size())
                nodes.resize(std::max<std::size_t>(64, 2 * visited));
            nodes[visited++] = id;
        }
    };

    /// A contour is walked again after this many planes even if nothing in it changes. This bounds the data
    /// that are kept of it for later planes, for any number of layers.
    static constexpr std::uint32_t longest_run = 64;

    /// Several walks at a time hide the latency of memory if nodes are scattered; one suffices if the graph
    /// fits into the cache.
    static constexpr std::size_t most_walkers = 20;
    static constexpr std::uint64_t candidates_per_walker = 64;

    template <class Found>
    void walk_from(std::uint32_t plane, std::span<const std::uint32_t> candidates, const Found& found) {
        const std::uint64_t count = candidates.size();
        if (count == 0)
            return;
        const std::size_t walkers = std::clamp<std::size_t>(count / candidates_per_walker, 1, most_walkers);
        if (walker_.size() < walkers)
            walker_.resize(walkers);
        std::size_t active = 0;
        for (std::size_t w = 0; w < walkers; ++w) {
            // Each walker has candidates of its own, so that walkers are far apart in the file and rarely
            // meet.
            walker_[active].candidate = count * w / walkers;
            walker_[active].candidates_end = count * (w + 1) / walkers;
            if (set_out(walker_[active], plane, candidates))
                ++active;
        }
        while (active > 1) {
            for (std::size_t w = 0; w < active;) {
                if (step(walker_[w], plane, found) || set_out(walker_[w], plane, candidates))
                    ++w;
                else
                    std::swap(walker_[w], walker_[--active]);
            }
        }
        if (active == 1) {
            do {
                while (step(walker_[0], plane, found)) {
                }
            } while (set_out(walker_[0], plane, candidates));
        }
    }

    /// Finds the walker's next unvisited candidate. Returns false if there is none.
    bool set_out(Walker& walker, std::uint32_t plane, std::span<const std::uint32_t> candidates) {
        while (walker.candidate < walker.candidates_end) {
            const std::uint32_t node = candidates[walker.candidate++];
            assert(node < graph_.count);
            if (marks_.marked(node, plane) || graph_.nodes[node].last <= plane)
                continue;
            walker.node = walker.start = node;
            walker.valid_until = end_of_run(plane);
            walker.visited = 0;
            return true;
        }
        return false;
    }

    /// Visits one node. Returns false when the walk ends.
    template <class Found>
    bool step(Walker& walker, std::uint32_t plane, const Found& found) {
        const std::uint32_t id = walker.node;
        if (marks_.marked(id, plane)) {
            if (walker.visited > 0) // else another walk visited the start before this one began
                finish(walker, plane, id, found);
            return false;
        }
        marks_.mark(id, plane + 1);
        const CutNode& node = graph_.nodes[id];
        assert(node.in_use() && node.first <= plane && plane < node.last);
        graph_.ends.prefetch(node.side); // needed when the run is measured
        walker.add(id);
        walker.valid_until = std::min<std::uint32_t>(walker.valid_until, node.last);
        std::uint32_t next = node.next_high;
        if (plane < node.split) {
            walker.valid_until = std::min(walker.valid_until, node.split);
            next = node.next_low;
        }
        if (next == no_node) {
            finish(walker, plane, no_node, found);
            return false;
        }
        walker.node = next;
        marks_.prefetch(next);
        __builtin_prefetch(&graph_.nodes[next]);
        return true;
    }

    template <class Found>
    void finish(Walker& walker, std::uint32_t plane, std::uint32_t met, const Found& found) {
        if (met == walker.start) {
            pass_on({walker.sequence(), walker.valid_until, true}, plane, found);
            return;
        }
        const std::uint64_t begin = pending_.size();
        const std::span<const std::uint32_t> sequence = walker.sequence();
        pending_.insert(pending_.end(), sequence.begin(), sequence.end());
        segments_.push_back({walker.start, met, begin, pending_.size(), walker.valid_until});
    }

    /// Joins walks that ran into one another. Links are one to one, so a walk can only run into the start of
    /// another, and at most one walk runs into each. Hence the walks form rings and chains.
    template <class Found>
    void join_segments(std::uint32_t plane, const Found& found) {
        std::sort(segments_.begin(), segments_.end(),
                  [](const Segment& a, const Segment& b) { return a.start < b.start; });
        std::vector<bool> followed(segments_.size());
        for (Segment& segment : segments_) {
            if (segment.next == no_node)
                continue;
            const auto met =
                std::lower_bound(segments_.begin(), segments_.end(), segment.next,
                                 [](const Segment& s, std::uint32_t node) { return s.start < node; });
            assert(met != segments_.end() && met->start == segment.next); // links are one to one
            segment.next = static_cast<std::uint32_t>(met - segments_.begin());
            assert(!followed[segment.next]);
            followed[segment.next] = true;
        }
        std::vector<bool> joined(segments_.size());
        const auto join = [&](std::uint32_t header, bool closed) {
            joined_.clear();
            std::uint32_t valid_until = end_of_run(plane);
            for (std::uint32_t s = header; s != no_node && !joined[s]; s = segments_[s].next) {
                joined[s] = true;
                valid_until = std::min(valid_until, segments_[s].valid_until);
                joined_.insert(joined_.end(),
                               pending_.begin() + static_cast<std::ptrdiff_t>(segments_[s].begin),
                               pending_.begin() + static_cast<std::ptrdiff_t>(segments_[s].end));
            }
            pass_on({joined_, valid_until, closed}, plane, found);
        };
        for (std::uint32_t s = 0; s < segments_.size(); ++s)
            if (!followed[s])
                join(s, false);
        for (std::uint32_t s = 0; s < segments_.size(); ++s)
            if (!joined[s])
                join(s, true);
        segments_.clear();
        pending_.clear();
    }

    [[nodiscard]] std::uint32_t end_of_run(std::uint32_t plane) const noexcept {
        return planes_.end - plane > longest_run ? plane + longest_run : planes_.end;
    }

    template <class Found>
    void pass_on(const NodeSequence& sequence, std::uint32_t plane, const Found& found) {
        assert(!sequence.nodes.empty());
        assert(plane < sequence.valid_until && sequence.valid_until <= planes_.end);
        if (sequence.valid_until < planes_.end) {
            std::vector<std::uint32_t>& again = restarts_[sequence.valid_until - planes_.begin];
            // If something changes where the sequence of a closed contour ends, the contour continues through
            // a node that begins there. If nothing changes, any node serves as the start. This does not hold
            // for open contours.
            if (!sequence.closed)
                again.insert(again.end(), sequence.nodes.begin(), sequence.nodes.end());
            else if (sequence.valid_until == end_of_run(plane))
                again.push_back(sequence.nodes.front());
        }
        found(sequence);
    }

    const LocatedGraph<Ends>& graph_;
    PlaneRange planes_;                      // planes of the task
    std::span<const std::uint32_t> carried_; // until they are walked
    VisitMarks marks_;
    std::vector<Walker> walker_;
    std::vector<Segment> segments_;      // segments of the current plane
    std::vector<std::uint32_t> pending_; // nodes of the segments
    std::vector<std::uint32_t> joined_;  // nodes of a contour made of segments
    /// Per plane of the task: the nodes of chains whose sequence ends before it, and one node of each contour
    /// that must be walked again.
    std::vector<std::vector<std::uint32_t>> restarts_;
};

} // namespace lamella
