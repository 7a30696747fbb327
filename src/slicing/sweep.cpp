#include "slicing/sweep.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "core/orientation.hpp"
#include "core/pages.hpp"
#include "slicing/cut_graph.hpp"
#include "slicing/cut_points.hpp"
#include "slicing/ordered_delivery.hpp"
#include "slicing/plane_index.hpp"
#include "slicing/point_arena.hpp"
#include "slicing/point_kernels.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

// The sweep engine
//
// Ranks turn heights into integers, the cut graph links every cut edge to its successors (cut_graph.hpp).
// What is left is to read contours off the graph, slab by slab (plane_index.hpp), each by one
// worker, or one slab by all of them:
//
// Walk. On plane i start from every node that begins there, and follow `next` until the start is reached. A
// contour without a new node is the continuation of one on the plane before; it is not searched for.
//
// Run. The sequence of nodes stays valid up to the first event in it: a node that ends or turns to its other
// successor. All planes up to there are a *run*, served by this one walk.
//
// Measure. For each plane of the run the points are computed, in the cache, only to learn where the ring
// starts in normal form and how many points it keeps. On their way through a run all points move along
// straight lines, so what is clear on two planes is so between them too, and is not measured there.
//
// Write. When a stretch of planes is complete, the rings of each layer are put in order, their places in the
// layer's array are known, and the points are computed again, straight into their places. To compute twice is
// cheaper than to move once: arithmetic in the cache costs a fraction of a trip to memory.
//
// The result is in normal form, so nothing of this order of work can be seen in it.

namespace lamella {

namespace {

/// One contour over the planes that its sequence of nodes serves.
struct Run {
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t size; ///< nodes
    bool closed;
    std::uint64_t sequence; ///< where its nodes start in the sequences
    std::uint64_t columns;  ///< where its edges start in the columns, or not_kept
    std::uint64_t rings;    ///< its Ring on plane p is rings[this + p - begin]
};

/// One contour on one plane.
struct Ring {
    Point2 first;        ///< the point it starts at
    std::uint32_t start; ///< the index of that point, after repeated points are dropped
    std::uint32_t count; ///< points kept; 0 when the contour shrank to a point or a line
    std::uint64_t place; ///< in the layer's array
};

/// What one worker computes with.
struct Bench {
    CutPoints points;
    PageArray<double> spare_columns; ///< of a run whose edges have no room in the columns
};

/// Reads the contours of one slab after the other off the graph. Each worker has its own, but for a slab that
/// all workers share: then one walks, and all measure, write and deliver.
template <class Ends>
class alignas(128) SlabSweep {
  public:
    SlabSweep(const CutGraph<Ends>& graph, const Ranks& ranks, const Plan& plan, const PlaneIndex& index,
              Executor& executor, OrderedDelivery& delivery)
        : graph_(graph), ranks_(ranks), plan_(plan), index_(index), executor_(executor), delivery_(delivery),
          arena_(index.all_points), visited_until_(graph.count, Fill::zero) {}

    /// Slabs must come in ascending order.
    void sweep(const Slab& slab) {
        slab_ = &slab;
        if (benches_.empty()) {
            benches_.resize(slab.shared ? executor_.workers() : 1);
            if (slab.shared)
                sequences_.reserve(index_.offsets.back());
            // Edges that stay in the columns stay in one core's cache.
            room_ = slab.shared ? 0 : std::min(most_room, EdgeColumns::padded(8 * index_.all_points));
            columns_ = PageArray<double>(EdgeColumns::columns * room_);
        }
        rings_of_plane_.assign(slab.end - slab.begin, {});
        ending_.assign(slab.end - slab.begin + std::size_t{1}, 0);
        restarts_.assign(slab.end - slab.begin, {});
        written_ = slab.begin;
        for (std::uint32_t plane = slab.begin; plane < slab.end; ++plane) {
            if (executor_.stopping())
                return;
            const std::size_t known = runs_.size();
            walk_plane(plane);
            if (slab.shared)
                share_runs(known, plane, slab.end,
                           [&](Run& run, std::uint32_t begin, std::uint32_t end, Bench& bench) {
                               if (begin == run.begin && end != begin) // one of its pieces
                                   spare_visits(run);
                               measure(run, begin, end, bench);
                           });
            list_rings(known, plane);
            stale_ += ending_[plane + 1 - slab.begin];
            const bool group_ends = plane + 1 == slab.end || plane + 1 - written_ == slab.group;
            const bool much_is_stale = stale_ >= stale_enough && stale_ >= carried_;
            if (much_is_stale || group_ends)
                write_layers(plane + 1);
            if (much_is_stale || plane + 1 == slab.end)
                forget_ended_runs(plane + 1);
        }
    }

  private:
    static constexpr std::uint64_t stale_enough = 1U << 15; // edges of runs that ended
    static constexpr std::uint64_t most_room = 1U << 16;    // edges; 3 MB of columns stay in the cache
    static constexpr std::uint64_t not_kept = ~std::uint64_t{0};
    static constexpr std::uint64_t large_layer = (std::uint64_t{2} << 20) / sizeof(Point2); // a large page

    // ------------------------------------------------------------------------------------------------- walk

    /// A walk from one start to where it met the start of a walk, or the end of the mesh.
    struct Segment {
        std::uint32_t start; ///< its first node
        std::uint32_t next;  ///< the segment it ran into, at first by its first node; no_node: the mesh ended
        std::uint64_t begin;
        std::uint64_t end;
        std::uint32_t valid_until;
    };

    /// A walk under way.
    struct Walker {
        std::uint32_t node;
        std::uint32_t start;
        std::uint32_t valid_until;
        std::uint64_t candidate; ///< the next one to look at
        std::uint64_t candidates_end;
        std::vector<std::uint32_t> sequence;
    };

    /// Several walks at a time hide the memory's latency where nodes lie scattered; one is enough where the
    /// graph fits the cache.
    static constexpr std::size_t most_walkers = 20;
    static constexpr std::uint64_t candidates_per_walker = 64;

    void walk_plane(std::uint32_t plane) {
        const std::uint32_t* starts = index_.starts.data() + index_.offsets[plane];
        walk_from(plane, starts, index_.offsets[plane + 1] - index_.offsets[plane]);
        if (plane == slab_->begin)
            walk_from(plane, slab_->carried.data(), slab_->carried.size());
        const std::vector<std::uint32_t> again = std::move(restarts_[plane - slab_->begin]);
        walk_from(plane, again.data(), again.size());
        if (!segments_.empty())
            link_segments(plane);
    }

    void walk_from(std::uint32_t plane, const std::uint32_t* candidates, std::uint64_t count) {
        if (count == 0)
            return;
        const std::size_t walkers = std::clamp<std::size_t>(count / candidates_per_walker, 1, most_walkers);
        if (walker_.size() < walkers)
            walker_.resize(walkers);
        std::size_t active = 0;
        for (std::size_t w = 0; w < walkers; ++w) {
            // Each has its own share of the candidates, so that they are far apart in the file and rarely
            // meet.
            walker_[active].candidate = count * w / walkers;
            walker_[active].candidates_end = count * (w + 1) / walkers;
            if (set_out(walker_[active], plane, candidates))
                ++active;
        }
        while (active > 1) {
            for (std::size_t w = 0; w < active;) {
                if (step(walker_[w], plane) || set_out(walker_[w], plane, candidates))
                    ++w;
                else
                    std::swap(walker_[w], walker_[--active]);
            }
        }
        if (active == 1) {
            do {
                while (step(walker_[0], plane)) {
                }
            } while (set_out(walker_[0], plane, candidates));
        }
    }

    /// Finds the walker's next unvisited candidate. False when there is none.
    bool set_out(Walker& walker, std::uint32_t plane, const std::uint32_t* candidates) {
        while (walker.candidate < walker.candidates_end) {
            const std::uint32_t node = candidates[walker.candidate++];
            if (visited_until_[node] > plane || graph_.nodes[node].last <= plane)
                continue;
            walker.node = walker.start = node;
            walker.valid_until = slab_->end;
            walker.sequence.clear();
            return true;
        }
        return false;
    }

    /// Visits one node. False when the walk is over.
    bool step(Walker& walker, std::uint32_t plane) {
        const std::uint32_t id = walker.node;
        if (visited_until_[id] > plane) {
            if (!walker.sequence.empty()) // else another walk came by before this one took its first step
                finish(walker, plane, id);
            return false;
        }
        visited_until_[id] = plane + 1;
        const CutNode<Ends>& node = graph_.nodes[id];
        walker.sequence.push_back(id);
        walker.valid_until = std::min<std::uint32_t>(walker.valid_until, node.last);
        std::uint32_t next = node.next_high;
        if (plane < node.split) {
            walker.valid_until = std::min(walker.valid_until, node.split);
            next = node.next_low;
        }
        if (next == no_node) {
            finish(walker, plane, no_node);
            return false;
        }
        walker.node = next;
        __builtin_prefetch(&visited_until_[next], 1);
        __builtin_prefetch(&graph_.nodes[next]);
        __builtin_prefetch(&graph_.nodes[next].ends);
        return true;
    }

    void finish(Walker& walker, std::uint32_t plane, std::uint32_t met) {
        if (met == walker.start) {
            add_run(plane, walker.valid_until, true, walker.sequence.data(), walker.sequence.size());
            return;
        }
        const std::uint64_t begin = pending_.size();
        pending_.insert(pending_.end(), walker.sequence.begin(), walker.sequence.end());
        segments_.push_back({walker.start, met, begin, pending_.size(), walker.valid_until});
    }

    /// Joins walks that ran into one another. Links are one to one, so a walk can only run into the start of
    /// another, and at most one runs into each: they form rings and chains of walks.
    void link_segments(std::uint32_t plane) {
        std::sort(segments_.begin(), segments_.end(),
                  [](const Segment& a, const Segment& b) { return a.start < b.start; });
        std::vector<bool> followed(segments_.size());
        for (Segment& segment : segments_) {
            if (segment.next == no_node)
                continue;
            const auto met =
                std::lower_bound(segments_.begin(), segments_.end(), segment.next,
                                 [](const Segment& s, std::uint32_t node) { return s.start < node; });
            segment.next = static_cast<std::uint32_t>(met - segments_.begin());
            followed[segment.next] = true;
        }
        std::vector<bool> done(segments_.size());
        const auto collect = [&](std::uint32_t head, bool closed) {
            joined_.clear();
            std::uint32_t valid_until = slab_->end;
            for (std::uint32_t s = head; s != no_node && !done[s]; s = segments_[s].next) {
                done[s] = true;
                valid_until = std::min(valid_until, segments_[s].valid_until);
                joined_.insert(joined_.end(),
                               pending_.begin() + static_cast<std::ptrdiff_t>(segments_[s].begin),
                               pending_.begin() + static_cast<std::ptrdiff_t>(segments_[s].end));
            }
            add_run(plane, valid_until, closed, joined_.data(), joined_.size());
        };
        for (std::uint32_t s = 0; s < segments_.size(); ++s)
            if (!followed[s])
                collect(s, false);
        for (std::uint32_t s = 0; s < segments_.size(); ++s)
            if (!done[s])
                collect(s, true);
        segments_.clear();
        pending_.clear();
    }

    // -------------------------------------------------------------------------------------- run and measure

    /// To be called for each ring and each layer: a slab whose layers are all kept is written in one go,
    /// which may take seconds. When another worker has failed, its error is the one that is told.
    void end_if_stopping() const {
        if (executor_.stopping())
            throw Error(ErrorKind::cancelled, "cancelled");
    }

    void add_run(std::uint32_t plane, std::uint32_t valid_until, bool closed, const std::uint32_t* sequence,
                 std::size_t size) {
        Run run{plane,    valid_until,  static_cast<std::uint32_t>(size), closed, sequences_.size(),
                not_kept, rings_.size()};
        sequences_.insert(sequences_.end(), sequence, sequence + size);
        ending_[valid_until - slab_->begin] += size;
        if (!closed && valid_until < slab_->end) {
            // Only a closed contour is sure to go on through a node that begins where its run ends.
            std::vector<std::uint32_t>& again = restarts_[valid_until - slab_->begin];
            again.insert(again.end(), sequence, sequence + size);
        }
        runs_.push_back(run);
        rings_.resize(rings_.size() + (valid_until - plane));
        if (slab_->shared)
            return; // served by all when the walk is over
        spare_visits(run);
        // Now, while its nodes are in the cache.
        const std::size_t stride = EdgeColumns::padded(size);
        if (room_ - columns_used_ >= stride) {
            runs_.back().columns = columns_used_;
            columns_used_ += stride;
        }
        measure(runs_.back(), plane, valid_until, benches_.front());
    }

    /// Later planes need no walk where the run goes.
    void spare_visits(const Run& run) {
        if (run.end > run.begin + 1)
            for (std::size_t i = 0; i < run.size; ++i)
                visited_until_[sequences_[run.sequence + i]] = run.end;
    }

    /// Calls work(run, begin, end, bench) for the runs from `first` on and the planes of each within
    /// [begin, end): in pieces, on all workers. Few runs are cut into pieces by their planes.
    template <class Work>
    void share_runs(std::size_t first, std::uint32_t begin, std::uint32_t end, const Work& work) {
        const std::uint64_t runs = runs_.size() - first;
        if (runs == 0)
            return;
        const std::uint64_t enough = 8 * benches_.size();
        const std::uint64_t pieces = std::clamp<std::uint64_t>(enough / runs, 1, end - begin);
        executor_.for_chunks(runs * pieces, std::max<std::uint64_t>(1, runs / enough),
                             [&](std::uint64_t from, std::uint64_t to, unsigned worker) {
                                 for (std::uint64_t i = from; i < to; ++i) {
                                     const std::uint64_t piece = i % pieces;
                                     Run& run = runs_[first + i / pieces];
                                     const std::uint32_t low = std::max(run.begin, begin);
                                     const std::uint64_t planes = std::max(std::min(run.end, end), low) - low;
                                     work(run, static_cast<std::uint32_t>(low + planes * piece / pieces),
                                          static_cast<std::uint32_t>(low + planes * (piece + 1) / pieces),
                                          benches_[worker]);
                                 }
                             });
    }

    /// Computes the rings of a run on the planes [begin, end), of which it serves all.
    void measure(Run& run, std::uint32_t begin, std::uint32_t end, Bench& bench) {
        if (begin == end)
            return;
        const EdgeColumns edges = lay_out_edges(run, bench);
        constexpr std::uint32_t worth_a_tolerance = 4; // planes
        if (!run.closed || end - begin < worth_a_tolerance) {
            for (std::uint32_t plane = begin; plane < end; ++plane)
                measure_ring(run, edges, plane, 0, bench);
            return;
        }
        const double tolerance = tolerance_of(edges, begin, end - 1);
        const bool begin_clear = measure_ring(run, edges, begin, tolerance, bench);
        const bool end_clear = measure_ring(run, edges, end - 1, tolerance, bench);
        measure_between(run, edges, {begin, begin_clear}, {end - 1, end_clear}, tolerance, bench);
    }

    /// What is farther apart than this on two planes of a run, as computed, is apart in truth, and what is so
    /// far apart in truth is apart as computed. 0 where that cannot be told.
    ///
    /// As computed a point is less than 7 * 2^-52 times the extent below away from its place (EdgeCut, and no
    /// edge of the run is lower than the distance of the two planes, so that no inverse overflows). Where two
    /// distances are a and b at least in truth, so is every distance between them if it moves along a
    /// line. Four points are in play, two there and two here: 28, and sqrt(2) times as much in the plane.
    double tolerance_of(const EdgeColumns& edges, std::uint32_t first, std::uint32_t last) const {
        const std::size_t stride = edges.stride();
        const auto largest = [&](std::size_t column) {
            return kernels_.largest(edges.data + column * stride, edges.size);
        };
        const double extent = std::max(largest(2) + largest(3), largest(4) + largest(5));
        const double tolerance = 0x1p-46 * extent;
        constexpr double least_normal = std::numeric_limits<double>::min();
        const bool told = tolerance * tolerance >= least_normal && std::isfinite(tolerance * tolerance) &&
                          ranks_.z(last) - ranks_.z(first) >= least_normal;
        return told ? tolerance : 0;
    }

    /// A plane of a run that is measured, and whether all was clear there.
    struct Measured {
        std::uint32_t plane;
        bool clear;
    };

    /// Computes the rings between two planes on which they are known.
    ///
    /// Points move along straight lines from plane to plane. Hence a point that is the leftmost by far on
    /// both planes is so between them. Neighbours lie on two edges of a triangle and come together in a
    /// corner that is not between the planes: the nearer they are to it the closer, so they are farther from
    /// one another between the planes than on one of them.
    void measure_between(Run& run, const EdgeColumns& edges, Measured low, Measured high, double tolerance,
                         Bench& bench) {
        if (high.plane - low.plane < 2)
            return;
        Ring* const rings = rings_.data() + run.rings - run.begin;
        if (low.clear && high.clear && rings[low.plane].start == rings[high.plane].start) {
            for (std::uint32_t plane = low.plane + 1; plane < high.plane; ++plane)
                take_over(run, edges, plane, rings[low.plane].start, bench);
            return;
        }
        const std::uint32_t middle = low.plane + (high.plane - low.plane) / 2;
        const bool clear = measure_ring(run, edges, middle, tolerance, bench);
        measure_between(run, edges, low, {middle, clear}, tolerance, bench);
        measure_between(run, edges, {middle, clear}, high, tolerance, bench);
    }

    /// Computes a ring that has all its points and starts at the one leftmost point, which is known.
    void take_over(Run& run, const EdgeColumns& edges, std::uint32_t plane, std::uint32_t start,
                   Bench& bench) {
        const double z = ranks_.z(plane);
        const auto point = [&](std::size_t i) {
            Point2 p;
            kernels_.cut(edges, i, i + 1, z, &p);
            return p;
        };
        const Point2 first = point(start);
        const Point2 before = point(start == 0 ? run.size - 1 : start - 1);
        const Point2 after = point(start + 1 == run.size ? 0 : start + 1);
        if (orientation(before, first, after) == 0) // it may be a line
            measure_ring(run, edges, plane, 0, bench);
        else
            rings_[run.rings + plane - run.begin] = {first, start, run.size, 0};
    }

    /// Notes for each plane the rings of the runs from `first` on.
    void list_rings(std::size_t first, std::uint32_t plane) {
        for (std::size_t r = first; r < runs_.size(); ++r) {
            const Run& run = runs_[r];
            for (std::uint32_t p = std::max(run.begin, plane); p < run.end; ++p) {
                const Ring& ring = rings_[run.rings + p - run.begin];
                if (ring.count != 0)
                    rings_of_plane_[p - slab_->begin].push_back(
                        {ring.first, run.rings + p - run.begin, run.closed});
            }
        }
    }

    /// Prepares the edges of a run for being cut: in the columns where it has room there, else for now.
    EdgeColumns lay_out_edges(const Run& run, Bench& bench) {
        const std::size_t stride = EdgeColumns::padded(run.size);
        double* z0 = nullptr;
        if (run.columns != not_kept) {
            z0 = columns_.data() + EdgeColumns::columns * run.columns;
        } else {
            if (bench.spare_columns.size() < EdgeColumns::columns * stride)
                bench.spare_columns = PageArray<double>(2 * EdgeColumns::columns * stride);
            z0 = bench.spare_columns.data();
        }
        double* far_z = z0 + stride;
        double* x0 = far_z + stride;
        double* far_x = x0 + stride;
        double* y0 = far_x + stride;
        double* far_y = y0 + stride;
        const bool low_is_base = ranks_.rule() == PlaneRule::section_above;
        const std::uint32_t* sequence = sequences_.data() + run.sequence;
        constexpr std::size_t ahead = 12;
        for (std::size_t i = 0; i < run.size; ++i) {
            if (i + ahead < run.size)
                __builtin_prefetch(&graph_.nodes[sequence[i + ahead]].ends);
            const Ends& ends = graph_.nodes[sequence[i]].ends;
            const Point3 base = low_is_base ? graph_.low(ends) : graph_.high(ends);
            const Point3 far = low_is_base ? graph_.high(ends) : graph_.low(ends);
            z0[i] = base.z;
            far_z[i] = far.z;
            x0[i] = base.x;
            far_x[i] = far.x;
            y0[i] = base.y;
            far_y[i] = far.y;
        }
        kernels_.prepare({z0, run.size});
        return {z0, run.size};
    }

    /// The edges of a run that was laid out before.
    EdgeColumns edges_of(const Run& run, Bench& bench) {
        if (run.columns == not_kept)
            return lay_out_edges(run, bench);
        return {columns_.data() + EdgeColumns::columns * run.columns, run.size};
    }

    /// Computes the ring of a run on a plane. True when its start is the leftmost point by more than the
    /// tolerance and all neighbours are farther than that from one another; never when that is 0.
    bool measure_ring(const Run& run, const EdgeColumns& edges, std::uint32_t plane, double tolerance,
                      Bench& bench) {
        end_if_stopping();
        CutPoints& points = bench.points;
        const CutSurvey survey = points.compute(edges, ranks_.z(plane));
        const double closest =
            run.closed ? std::min(survey.closest, points.squared_closing()) : survey.closest;
        const bool repeats = !(closest > 0);
        if (repeats)
            points.drop_repeats(run.closed);
        const auto count = static_cast<std::uint32_t>(points.size());
        Ring& ring = rings_[run.rings + plane - run.begin];
        ring = {points[0], 0, 0, 0};
        if (!run.closed) {
            ring.count = count >= 2 ? count : 0;
            return false;
        }
        if (count < 3)
            return false;
        const RingStart start = points.start(survey.least_x, tolerance, repeats);
        if (start.flat)
            return false;
        ring = {points[start.index], static_cast<std::uint32_t>(start.index), count, 0};
        return tolerance > 0 && start.alone && closest > tolerance * tolerance;
    }

    // ------------------------------------------------------------------------------------------------ write

    struct Order {
        Point2 first;
        std::uint64_t ring;
        bool closed;
    };

    /// A layer on its way out.
    struct Outgoing {
        std::uint64_t begin = 0; ///< of its points in the piece of memory that the outgoing layers share
        Layer layer;
    };

    /// Calls body(begin, end, bench) over [0, n), in parallel in a slab that all workers share.
    template <class Body>
    void for_all(std::uint64_t n, const Body& body) {
        if (slab_->shared)
            executor_.for_chunks(n, 1, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
                body(begin, end, benches_[worker]);
            });
        else
            body(0, n, benches_.front());
    }

    /// Writes and delivers the planes [written_, end).
    void write_layers(std::uint32_t end) {
        std::vector<Outgoing> outgoing(end - written_);
        for_all(outgoing.size(), [&](std::uint64_t from, std::uint64_t to, Bench& bench) {
            for (std::uint64_t i = from; i < to; ++i) {
                end_if_stopping();
                lay_out_layer(static_cast<std::uint32_t>(written_ + i), outgoing[i].layer, bench);
            }
        });
        std::uint64_t total = 0;
        for (Outgoing& out : outgoing) {
            out.begin = total;
            total += out.layer.offsets.back();
        }

        const PointArena::Piece piece = arena_.take(total);
        // The rings of a run are written layer after layer. Where layers are large, each line of memory has
        // left the cache since its page was cleared or used before, and is best not fetched again.
        const bool past_cache = outgoing.size() > 1 && total / outgoing.size() >= large_layer;
        const auto write_run = [&](const Run& run, std::uint32_t first, std::uint32_t last, Bench& bench) {
            EdgeColumns edges{};
            for (std::uint32_t p = first; p < last; ++p) {
                const Ring& ring = rings_[run.rings + p - run.begin];
                if (ring.count == 0)
                    continue;
                end_if_stopping();
                if (edges.data == nullptr)
                    edges = edges_of(run, bench);
                write_ring(edges, run.closed, p, ring,
                           piece.points + outgoing[p - written_].begin + ring.place, past_cache, bench);
            }
        };
        if (slab_->shared) {
            share_runs(0, written_, end, write_run);
        } else {
            for (const Run& run : runs_)
                write_run(run, std::max(run.begin, written_), std::min(run.end, end), benches_.front());
        }

        for_all(outgoing.size(), [&](std::uint64_t from, std::uint64_t to, Bench&) {
            for (std::uint64_t i = from; i < to; ++i) {
                end_if_stopping();
                const auto plane = static_cast<std::uint32_t>(written_ + i);
                const PlannedLayer& planned = plan_.layers[plane];
                Layer& layer = outgoing[i].layer;
                layer.index = planned.index;
                layer.z = planned.z;
                layer.bottom = planned.bottom;
                layer.top = planned.top;
                if (layer.offsets.back() != 0)
                    layer.points =
                        PointArray(piece.owner, piece.points + outgoing[i].begin, layer.offsets.back());
                delivery_.deliver(plane, std::move(layer));
            }
        });
        written_ = end;
    }

    /// Puts the contours of a plane in order and gives each its place.
    void lay_out_layer(std::uint32_t plane, Layer& layer, Bench& bench) {
        std::vector<Order>& order = rings_of_plane_[plane - slab_->begin];
        std::sort(order.begin(), order.end(), [](const Order& a, const Order& b) {
            return a.closed != b.closed ? a.closed : a.first < b.first;
        });
        for (std::size_t i = 0; i + 1 < order.size();) {
            std::size_t end = i + 1;
            while (end < order.size() && order[end].closed == order[i].closed &&
                   order[end].first == order[i].first)
                ++end;
            if (end - i > 1)
                sort_by_sequence(plane, order.begin() + static_cast<std::ptrdiff_t>(i),
                                 order.begin() + static_cast<std::ptrdiff_t>(end), bench);
            i = end;
        }
        layer.offsets.resize(order.size() + 1);
        std::uint64_t size = 0;
        for (std::size_t i = 0; i < order.size(); ++i) {
            Ring& ring = rings_[order[i].ring];
            ring.place = size;
            size += ring.count;
            layer.offsets[i + 1] = size;
            layer.rings += order[i].closed;
        }
        std::vector<Order>().swap(order);
    }

    /// Contours that start at the same point (they touch there) are ordered by all their points.
    template <class Iterator>
    void sort_by_sequence(std::uint32_t plane, Iterator begin, Iterator end, Bench& bench) {
        std::vector<std::pair<std::vector<Point2>, Order>> contours;
        for (Iterator it = begin; it != end; ++it) {
            // The run is the last one whose rings do not begin behind this ring.
            const auto run =
                std::prev(std::upper_bound(runs_.begin(), runs_.end(), it->ring,
                                           [](std::uint64_t ring, const Run& r) { return ring < r.rings; }));
            const Ring& ring = rings_[it->ring];
            std::vector<Point2> points(ring.count);
            write_ring(edges_of(*run, bench), run->closed, plane, ring, points.data(), false, bench);
            contours.emplace_back(std::move(points), *it);
        }
        std::stable_sort(contours.begin(), contours.end(),
                         [](const auto& a, const auto& b) { return stands_before(a.first, b.first); });
        for (std::size_t i = 0; i < contours.size(); ++i, ++begin)
            *begin = contours[i].second;
    }

    void write_ring(const EdgeColumns& edges, bool closed, std::uint32_t plane, const Ring& ring, Point2* to,
                    bool past_cache, Bench& bench) {
        const double z = ranks_.z(plane);
        if (ring.count == edges.size) {
            const auto cut = past_cache ? kernels_.cut_past_cache : kernels_.cut;
            cut(edges, ring.start, edges.size, z, to);
            cut(edges, 0, ring.start, z, to + (edges.size - ring.start));
            return;
        }
        CutPoints& points = bench.points;
        points.compute(edges, z);
        points.drop_repeats(closed);
        const std::size_t n = points.size();
        for (std::size_t i = 0; i < n; ++i)
            to[i] = points[i + ring.start < n ? i + ring.start : i + ring.start - n];
    }

    /// Forgets the runs that end before `plane` (all planes before it are written), and moves the others
    /// together.
    void forget_ended_runs(std::uint32_t plane) {
        std::vector<Run> runs;
        std::vector<Ring> rings;
        std::uint64_t edges = 0;
        std::uint64_t columns = 0;
        for (const Run& run : runs_) {
            if (run.end <= plane)
                continue;
            const std::uint32_t begin = std::max(run.begin, plane);
            Run kept{begin, run.end, run.size, run.closed, edges, run.columns, rings.size()};
            const auto sequence = sequences_.begin() + static_cast<std::ptrdiff_t>(run.sequence);
            std::copy(sequence, sequence + run.size, sequences_.begin() + static_cast<std::ptrdiff_t>(edges));
            edges += run.size;
            if (run.columns != not_kept) {
                const std::uint64_t stride = EdgeColumns::padded(run.size);
                const double* from = columns_.data() + EdgeColumns::columns * run.columns;
                std::copy(from, from + EdgeColumns::columns * stride,
                          columns_.data() + EdgeColumns::columns * columns);
                kept.columns = columns;
                columns += stride;
            }
            const auto ring = rings_.begin() + static_cast<std::ptrdiff_t>(run.rings);
            rings.insert(rings.end(), ring + (begin - run.begin), ring + (run.end - run.begin));
            runs.push_back(kept);
        }
        runs_ = std::move(runs);
        rings_ = std::move(rings);
        sequences_.resize(edges);
        columns_used_ = columns;
        carried_ = edges;
        stale_ = 0;
        for (std::vector<Order>& order : rings_of_plane_)
            order.clear();
        list_rings(0, plane);
    }

    const CutGraph<Ends>& graph_;
    const Ranks& ranks_;
    const Plan& plan_;
    const PlaneIndex& index_;
    Executor& executor_;
    OrderedDelivery& delivery_;
    const PointKernels& kernels_ = point_kernels();

    PointArena arena_;
    const Slab* slab_ = nullptr;
    PageArray<std::uint32_t> visited_until_; // per node: the plane before which it needs no visit
    std::vector<Walker> walker_;
    std::vector<Segment> segments_;
    std::vector<std::uint32_t> pending_;
    std::vector<std::uint32_t> joined_;
    /// Per plane of the slab: the nodes of chains whose run ends before it.
    std::vector<std::vector<std::uint32_t>> restarts_;

    std::vector<std::uint32_t> sequences_; // the nodes of the runs
    PageArray<double> columns_;            // the prepared edges of the first runs, as many as have room
    std::uint64_t room_ = 0;               // for edges, in the columns
    std::uint64_t columns_used_ = 0;
    std::uint64_t carried_ = 0;
    std::uint64_t stale_ = 0;
    std::vector<Run> runs_;
    std::vector<Ring> rings_;
    std::vector<std::vector<Order>> rings_of_plane_;
    std::vector<std::uint64_t> ending_;
    std::vector<Bench> benches_; // one, or one for each worker
    std::uint32_t written_ = 0;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class Ends>
void sweep_graph(const SliceJob& job, const CutGraph<Ends>& graph, const Ranks& ranks, Executor& executor) {
    const auto start = Clock::now();
    ProgressMeter progress(job.execution, Stage::slice, ranks.count());
    OrderedDelivery delivery(job.sink, executor, progress);

    std::vector<Slab> slabs;
    const PlaneIndex index = index_planes(graph, ranks.count(), job.points_in_flight, executor, slabs);
    std::vector<std::unique_ptr<SlabSweep<Ends>>> sweeps(executor.workers());
    const auto sweep = [&](const Slab& slab, unsigned worker) {
        if (!sweeps[worker])
            sweeps[worker] =
                std::make_unique<SlabSweep<Ends>>(graph, ranks, job.plan, index, executor, delivery);
        sweeps[worker]->sweep(slab);
    };
    if (slabs.size() == 1) {
        sweep(slabs.front(), 0);
    } else {
        executor.for_chunks(slabs.size(), 1, [&](std::uint64_t s, std::uint64_t, unsigned worker) {
            const bool bounded = job.points_in_flight != 0 && s > executor.workers();
            if (bounded && !delivery.wait_for(slabs[s - executor.workers()].begin))
                return;
            sweep(slabs[s], worker);
        });
    }
    executor.check_cancelled();
    progress.finish();
    job.report.slice_seconds = seconds_since(start);
}

} // namespace

void run_sweep(const SliceJob& job) {
    Executor executor(job.execution);
    const auto start = Clock::now();
    const Ranks ranks(job.plan);
    ProgressMeter progress(job.execution, Stage::link, job.mesh.size());
    const auto sweep = [&](const auto& graph) {
        progress.finish();
        job.report.link_seconds = seconds_since(start);
        sweep_graph(job, graph, ranks, executor);
    };
    if (job.mesh.indexed() != nullptr)
        sweep(build_cut_graph(*job.mesh.indexed(), ranks, executor, progress));
    else if (job.mesh.soup()->has_placement())
        sweep(build_placed_cut_graph(*job.mesh.soup(), ranks, executor, progress));
    else
        sweep(build_cut_graph(*job.mesh.soup(), ranks, executor, progress));
}

} // namespace lamella
