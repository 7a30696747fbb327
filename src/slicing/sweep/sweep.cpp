#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"
#include "core/ordered_stage.hpp"
#include "core/stopwatch.hpp"
#include "slicing/slice_job.hpp"
#include "slicing/sweep/crew.hpp"
#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/emit.hpp"
#include "slicing/sweep/measure.hpp"
#include "slicing/sweep/plane_loads.hpp"
#include "slicing/sweep/point_arena.hpp"
#include "slicing/sweep/runs.hpp"
#include "slicing/sweep/schedule.hpp"
#include "slicing/sweep/start_index.hpp"
#include "slicing/sweep/walk.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <span>
#include <vector>

// The sweep engine
//
// Ranks convert heights to integers, and the cut graph links every cut edge to its successors
// (cut_graph.hpp). The contours are then read from the graph. The planes are divided into tasks
// (schedule.hpp), each for one worker, or one task for all workers. On one plane after the other:
//
//     walk       follow the links from every node that begins there: walk.hpp
//     run        the sequence of nodes serves all planes up to its first event: runs.hpp
//     measure    on each plane of the run, find the start of the ring and its number of points: measure.hpp
//     emit       once a range of planes is complete, sort the rings of each layer and compute the points
//                again, directly into the arrays of the layers: emit.hpp
//
// The result is in normal form, so it does not depend on the order of this work.

namespace lamella {

namespace {

/// Sweeps one task after the other on behalf of one worker.
template <class Ends>
class alignas(128) Sweep {
  public:
    /// Requires that all tasks are shared if `first` is, and that none has a larger group.
    Sweep(const LocatedGraph<Ends>& graph, const SharedMarks& marks, const StartIndex& starts,
          const PlaneLoads& loads, const Ranks& ranks, const Plan& plan, const SweepTask& first,
          Executor& executor, const LayerSink& sink, OrderedStage& delivery)
        : graph_(graph), starts_(starts), ranks_(ranks), plan_(plan), sink_(sink), delivery_(delivery),
          crew_(executor, first.shared), walk_(graph, marks), columns_(room_for_columns(loads, first.shared)),
          arena_(std::min(loads.all_points, first.group * loads.most_points)) {
        if (first.shared)
            runs_.reserve_nodes(loads.begun.back());
    }

    /// Sweeps a task. Requires tasks in ascending order, and in `carried` the nodes that reach into this one
    /// from below.
    void sweep(const SweepTask& task, std::span<const std::uint32_t> carried) {
        assert(task.shared == crew_.shared() && task.group > 0);
        const PlaneRange planes = task.planes;
        walk_.begin_task(planes, carried);
        runs_.begin_task(planes);
        entries_.begin_task(planes);
        std::uint32_t emitted = planes.begin;
        for (std::uint32_t plane = planes.begin; plane < planes.end; ++plane) {
            if (crew_.executor().stopping())
                return;
            const std::size_t known = runs_.all().size();
            walk_.walk(plane, starts_.starts(plane),
                       [&](const NodeSequence& sequence) { add_run(plane, sequence); });
            if (crew_.shared())
                measure_together(runs_.all().subspan(known), planes);
            entries_.add(runs_.all().subspan(known), runs_, plane);

            const bool last = plane + 1 == planes.end;
            const bool much_is_stale = runs_.end_plane(plane);
            if (much_is_stale || last || plane + 1 - emitted == task.group) {
                emit({emitted, plane + 1}, plan_, ranks_, runs_, entries_, edges_of(), crew_, arena_, sink_,
                     delivery_);
                emitted = plane + 1;
            }
            if (much_is_stale || last)
                forget_before(plane + 1);
        }
    }

  private:
    /// Stored columns must fit into the cache of one core. If all workers share the work, columns would have
    /// to leave this cache, so none are stored.
    static std::uint64_t room_for_columns(const PlaneLoads& loads, bool shared) {
        constexpr std::uint64_t most = 1U << 16; // edges: 3 MB
        return shared ? 0 : std::min<std::uint64_t>(most, EdgeColumns::padded(8 * loads.all_points));
    }

    /// Adds a run. In a task of one worker it is measured now, while its nodes are in the cache.
    void add_run(std::uint32_t plane, const NodeSequence& sequence) {
        Run& run = runs_.add(plane, sequence);
        if (crew_.shared())
            return; // all workers measure it after the walk
        skip_walks(run);
        run.columns = columns_.reserve(run.size);
        measure_run(run, {run.begin, run.end}, crew_.scratch());
    }

    void measure_together(std::span<Run> runs, PlaneRange planes) {
        crew_.for_runs(runs, planes, [&](const Run& run, PlaneRange part, Scratch& scratch) {
            if (part.begin == run.begin) // the first part of the run
                skip_walks(run);
            measure_run(run, part, scratch);
        });
    }

    /// Marks the nodes of the run: its later planes need no walk over them.
    void skip_walks(const Run& run) {
        if (run.end > run.begin + 1)
            walk_.skip(runs_.nodes(run), run.end);
    }

    void measure_run(const Run& run, PlaneRange planes, Scratch& scratch) {
        measure_rings({lay_out(run, scratch), run.closed}, planes, ranks_, crew_.executor(),
                      runs_.rings(run, planes), scratch);
    }

    /// Lays out the edges of a run, in the store if the run has an offset there.
    EdgeColumns lay_out(const Run& run, Scratch& scratch) const {
        return lay_out_edges(graph_, ranks_, runs_.nodes(run), scratch.kernels,
                             run.columns == ColumnStore::not_kept ? scratch.columns_for(run.size)
                                                                  : columns_.at(run.columns));
    }

    /// Returns a function from a run to its prepared edges.
    [[nodiscard]] auto edges_of() const {
        return [this](const Run& run, Scratch& scratch) -> EdgeColumns {
            if (run.columns == ColumnStore::not_kept)
                return lay_out(run, scratch);
            return {columns_.at(run.columns), run.size, ranks_.snap_mm()};
        };
    }

    void forget_before(std::uint32_t plane) {
        runs_.forget_before(plane, columns_);
        entries_.clear(); // the rings have new indices
        entries_.add(runs_.all(), runs_, plane);
    }

    const LocatedGraph<Ends>& graph_;
    const StartIndex& starts_;
    const Ranks& ranks_;
    const Plan& plan_;
    const LayerSink& sink_;
    OrderedStage& delivery_;
    Crew crew_;
    Walk<Ends> walk_;
    Runs runs_;
    ColumnStore columns_;
    EntryLists entries_;
    PointArena arena_;
};

template <class Ends>
void sweep_graph(const SliceJob& job, const LocatedGraph<Ends>& graph, const Ranks& ranks,
                 Executor& executor) {
    const Stopwatch slicing;
    ProgressMeter progress(job.execution, Stage::slice, ranks.count());
    OrderedStage delivery(executor, progress);

    const std::vector<NodeRange> shares = count_nodes(graph, ranks.count(), executor);
    const PlaneLoads loads = loads_of(shares, ranks.count());
    const std::vector<SweepTask> tasks = schedule(loads, executor.workers(), job.points_in_flight);
    const StartIndex starts(graph, shares, loads, tasks, executor);
    const SharedMarks marks(graph.count, Fill::zero);
    std::vector<std::unique_ptr<Sweep<Ends>>> sweeps(executor.workers());
    const auto sweep_for = [&](std::size_t task, unsigned worker) -> Sweep<Ends>& {
        if (!sweeps[worker])
            sweeps[worker] = std::make_unique<Sweep<Ends>>(graph, marks, starts, loads, ranks, job.plan,
                                                           tasks[task], executor, job.sink, delivery);
        return *sweeps[worker];
    };
    if (tasks.size() == 1) {
        sweep_for(0, 0).sweep(tasks[0], starts.carried(0));
    } else {
        executor.for_chunks(tasks.size(), 1, [&](std::uint64_t t, std::uint64_t, unsigned worker) {
            const bool bounded = job.points_in_flight != 0 && t > executor.workers();
            if (bounded && !delivery.wait_for(tasks[t - executor.workers()].planes.begin))
                return;
            sweep_for(t, worker).sweep(tasks[t], starts.carried(t));
        });
    }
    executor.check_cancelled();
    assert(delivery.delivered() == ranks.count());
    progress.finish();
    job.report.slice_seconds = slicing.seconds();
}

} // namespace

void slice_by_sweep(const SliceJob& job) {
    Executor executor(job.execution);
    const Stopwatch linking;
    const Ranks ranks(job.plan);
    ProgressMeter progress(job.execution, Stage::link, job.mesh.size());
    const auto linked = [&](const auto& graph) -> const auto& {
        progress.finish();
        job.report.link_seconds = linking.seconds();
        return graph;
    };
    RangeVisitor visit;
    if (job.visitor != nullptr)
        visit = [&job](std::uint64_t begin, std::uint64_t end) {
            (*job.visitor)(job.mesh, begin, end);
        };
    if (job.mesh.indexed() != nullptr)
        sweep_graph(job, linked(build_cut_graph(*job.mesh.indexed(), ranks, executor, progress, visit)),
                    ranks, executor);
    else if (job.mesh.soup()->has_placement())
        sweep_graph(job, linked(build_placed_cut_graph(*job.mesh.soup(), ranks, executor, progress, visit)),
                    ranks, executor);
    else
        sweep_graph(job, linked(build_cut_graph(*job.mesh.soup(), ranks, executor, progress, visit)), ranks,
                    executor);
}

} // namespace lamella
