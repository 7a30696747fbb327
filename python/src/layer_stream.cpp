#include "layer_stream.hpp"

#include "lamella/core/error.hpp"
#include "lamella/jobs/slice_file.hpp"

#include "gil_release.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#ifndef _WIN32
#include <unistd.h>
#endif

namespace py = pybind11;

namespace lamella::python {
namespace {

// 16 MB, so that threads need not wait for each other.
constexpr std::size_t most_points = (std::size_t{16} << 20) / sizeof(Point2);

long this_process() {
#ifdef _WIN32
    return 0; // there is no fork
#else
    return ::getpid();
#endif
}

} // namespace

void LayerQueue::put(MendedLayer&& made) {
    std::unique_lock lock(mutex_);
    const auto has_room = [&] {
        return closed_.requested() || waiting_.empty() || points_ + made.points <= most_points;
    };
    room_.wait(lock, has_room);
    if (closed_.requested())
        throw Error(ErrorKind::cancelled, "cancelled");
    points_ += made.points;
    waiting_.push_back(std::move(made));
    news_.notify_one();
}

void LayerQueue::end(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    failure_ = std::move(failure);
    news_.notify_all();
}

void LayerQueue::close() {
    const std::lock_guard lock(mutex_);
    closed_.request();
    room_.notify_all();
}

LayerQueue::Found LayerQueue::take(MendedLayer& made) {
    std::unique_lock lock(mutex_);
    if (!news_.wait_for(lock, between_signals, [&] { return !waiting_.empty() || ended_; }))
        return Found::nothing_yet;
    if (!waiting_.empty()) {
        made = std::move(waiting_.front());
        waiting_.pop_front();
        points_ -= made.points;
        room_.notify_one();
        return Found::layer;
    }
    if (failure_)
        std::rethrow_exception(std::exchange(failure_, nullptr));
    return Found::end;
}

MendedLayer CutPlan::mended(std::span<const Layer> bodies, const SourcePlate& plate,
                            const LayerLimits& limits) const {
    MendedLayer made;
    ClosedPlane closed;
    if (close_gaps_mm) {
        closed = close_gaps_on_plane(bodies, *close_gaps_mm, limits);
        made.joins = std::move(closed.joins);
        bodies = closed.layers;
    }
    PlateMaterial material = material_of(bodies, plate.mended.negatives, {.fill = fill}, limits);
    made.changes = material.changes;
    std::vector<Layer>& parts = material.parts;
    // By itself, because the figures of the repair `fill` do not count it.
    if (bottom.inset_mm != 0)
        parts = take_steps_on_plane({.bottom = bottom}, parts, limits).parts;
    std::vector<LayerPointer> apart;
    Layer whole = parts.size() == 1 ? with_own_points(std::move(parts.front())) : merged(parts);
    made.points = whole.points.size();
    if (plate.several())
        for (Layer& part : parts) {
            made.points += part.points.size();
            apart.push_back(std::make_shared<SharedLayer>(with_own_points(std::move(part)), plan.rule));
        }
    made.layer = std::make_shared<SharedLayer>(std::move(whole), plan.rule, PointArray(), std::move(apart));
    return made;
}

void CutPlan::add(Repairs& sum, const MendedLayer& layer) const {
    if (close_gaps_mm)
        python::add(sum, layer.joins);
    if (fill != FillRule::none)
        python::add(sum, layer.changes);
}

Plan CutPlan::only(std::uint64_t begin, std::uint64_t end, const SourcePlate& plate,
                   const Execution& execution) const {
    FileJob job;
    job.layering = layering;
    job.layering.only = {.index_range = {{begin, end}}};
    return plan_of(job, plate.placed, execution);
}

LayerStream::LayerStream(PlatePointer plate, CutPlan cuts, const Engine& with, unsigned threads,
                         py::object listener)
    : plate_(std::move(plate)), cuts_(std::move(cuts)), engine_(with), threads_(threads),
      listener_(std::move(listener)), process_(this_process()), repairs_(plate_->repairs) {
    cuts_.add(repairs_, {});
    Execution execution{.threads = threads, .cancel = &shared_->queue.closed()};
    if (!listener_.is_none())
        execution.progress = [this](const Progress& progress) {
            shared_->progress.put(progress);
        };
    worker_ = std::thread([this, execution] {
        std::exception_ptr failure;
        try {
            const PlateSink sink{.prepare = [&](const Plane& bodies) -> Commit {
                return [this,
                        kept = cuts_.mended(bodies.polylines, *plate_, layer_limits(execution))]() mutable {
                    shared_->queue.put(std::move(kept));
                };
            }};
            slice_to(sink, plate_->mended, plan(), {.execution = execution, .engine = engine_});
        } catch (...) {
            failure = std::current_exception();
        }
        shared_->queue.end(std::move(failure));
    });
}

// Joining a worker that no other thread owns does not fail.
LayerStream::~LayerStream() { // NOLINT(bugprone-exception-escape)
    close();
}

bool LayerStream::forked() const {
    return this_process() != process_;
}

LayerPointer LayerStream::next() {
    if (forked() && !closed_)
        throw Error(ErrorKind::usage,
                    "this stream of layers was made before the process was forked, and the "
                    "threads that slice stay in the process that made it; make a stream here");
    try {
        for (MendedLayer made; !closed_;) {
            LayerQueue::Found found = LayerQueue::Found::nothing_yet;
            {
                const GilRelease released;
                found = shared_->queue.take(made);
            }
            // A copy, because the listener may close the stream, which releases the listener.
            report(shared_->progress, py::object(listener_));
            check_signals();
            if (found == LayerQueue::Found::end)
                close();
            else if (found == LayerQueue::Found::layer) {
                ++taken_;
                cuts_.add(repairs_, made);
                return std::move(made.layer);
            }
        }
    } catch (
        const py::error_already_set&) { // of the listener, which may have closed the stream, or an interrupt
        close();
        throw;
    } catch (...) {
        if (closed_) // closed by another thread in the meantime
            throw py::stop_iteration();
        close();
        throw;
    }
    throw py::stop_iteration();
}

void LayerStream::close() {
    closed_ = true;
    // If several threads close the stream, only one gets the worker.
    std::thread worker = std::move(worker_);
    if (forked()) {
        if (worker.joinable())
            worker.detach();
        static_cast<void>(shared_.release()); // NOLINT(bugprone-unused-return-value): see Shared
    } else {
        const GilRelease released;
        shared_->queue.close();
        if (worker.joinable())
            worker.join();
    }
    forget_listener();
}

double LayerStream::bottom() const {
    if (left() == 0)
        throw Error(ErrorKind::usage, "no layers are left: the stream is closed or at its end");
    return plan().layers[taken_].bottom;
}

LayerStream::Beside LayerStream::beside(std::uint64_t below, std::uint64_t above) const {
    const PlaneSelection& only = cuts_.layering.only;
    if (left() == 0 || (taken_ == 0 && !only.z_range && !only.index_range))
        return {};
    const std::uint64_t first = plan().layers[taken_].index;
    const std::uint64_t last = plan().layers.back().index;
    const std::uint64_t lowest = first - std::min(first, below);
    return result_of(threads_, py::none(), [&](const Execution& execution) {
        // Includes layers that were already taken, because all remaining layers may miss the part, which is
        // an error for a plan.
        const Plan wider =
            cuts_.only(std::min(lowest, plan().layers.front().index), last + 1 + above, *plate_, execution);
        const auto sliced = [&](const auto& wanted) {
            Plan some{{}, wider.rule, wider.snap_mm};
            std::copy_if(wider.layers.begin(), wider.layers.end(), std::back_inserter(some.layers), wanted);
            return some.layers.empty()
                       ? std::vector<LayerPointer>()
                       : lamella::python::sliced(*plate_, cuts_, some, execution, engine_, nullptr);
        };
        return Beside{
            sliced([&](const PlannedLayer& layer) { return lowest <= layer.index && layer.index < first; }),
            sliced([&](const PlannedLayer& layer) { return layer.index > last; })};
    });
}

std::vector<LayerPointer> sliced(const SourcePlate& plate, const CutPlan& cuts, const Plan& plan,
                                 const Execution& execution, const Engine& engine, Repairs* repairs) {
    std::vector<LayerPointer> layers;
    layers.reserve(plan.layers.size());
    const PlateSink sink{.prepare = [&](const Plane& bodies) -> Commit {
        return [&, made = cuts.mended(bodies.polylines, plate, layer_limits(execution))]() mutable {
            if (repairs != nullptr)
                cuts.add(*repairs, made);
            layers.push_back(std::move(made.layer));
        };
    }};
    slice_to(sink, plate.mended, plan, {.execution = execution, .engine = engine});
    return layers;
}

} // namespace lamella::python
