#include "layer_stream.hpp"

#include "lamella/core/error.hpp"
#include "lamella/pipeline/slice_file.hpp"

#include "gil_release.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace py = pybind11;

namespace lamella::python {
namespace {

// 16 MB, so that threads need not wait for each other.
constexpr std::size_t most_points = (std::size_t{16} << 20) / sizeof(Point2);

} // namespace

void LayerQueue::put(Layer&& layer) {
    std::unique_lock lock(mutex_);
    const auto has_room = [&] {
        return closed_.requested() || waiting_.empty() || points_ + layer.points.size() <= most_points;
    };
    room_.wait(lock, has_room);
    if (closed_.requested())
        throw Error(ErrorKind::cancelled, "cancelled");
    points_ += layer.points.size();
    waiting_.push_back(std::move(layer));
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

LayerQueue::Found LayerQueue::take(Layer& layer) {
    std::unique_lock lock(mutex_);
    if (!news_.wait_for(lock, between_signals, [&] { return !waiting_.empty() || ended_; }))
        return Found::nothing_yet;
    if (!waiting_.empty()) {
        layer = std::move(waiting_.front());
        waiting_.pop_front();
        points_ -= layer.points.size();
        room_.notify_one();
        return Found::layer;
    }
    if (failure_)
        std::rethrow_exception(std::exchange(failure_, nullptr));
    return Found::end;
}

Plan CutPlan::only(std::uint64_t begin, std::uint64_t end, const SourceMesh& mesh,
                   const Execution& execution) const {
    FileJob job;
    job.layering = layering;
    job.layering.only = {.index_range = {{begin, end}}};
    return plan_of(job, mesh.plate(), execution);
}

LayerStream::LayerStream(MeshPointer mesh, CutPlan cuts, const Engine& with, unsigned threads,
                         py::object listener)
    : mesh_(std::move(mesh)), cuts_(std::move(cuts)), engine_(with), threads_(threads),
      listener_(std::move(listener)) {
    Execution execution{.threads = threads, .cancel = &queue_.closed()};
    if (!listener_.is_none())
        execution.progress = [this](const Progress& progress) {
            progress_.put(progress);
        };
    worker_ = std::thread([this, execution] {
        std::exception_ptr failure;
        try {
            const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
                return [this, kept = with_own_points(std::move(layer))]() mutable {
                    queue_.put(std::move(kept));
                };
            }};
            const SliceOptions options{.execution = execution, .engine = engine_};
            if (mesh_->source().has_negatives())
                slice_to(sink, mesh_->source().plate(execution), plan(), options);
            else
                slice_to(sink, mesh_->mesh(), plan(), options);
        } catch (...) {
            failure = std::current_exception();
        }
        queue_.end(std::move(failure));
    });
}

// Joining a worker that no other thread owns does not fail.
LayerStream::~LayerStream() { // NOLINT(bugprone-exception-escape)
    close();
}

LayerPointer LayerStream::next() {
    try {
        for (Layer layer; !closed_;) {
            LayerQueue::Found found = LayerQueue::Found::nothing_yet;
            {
                const GilRelease released;
                found = queue_.take(layer);
            }
            // A copy, because the listener may close the stream, which releases the listener.
            report(progress_, py::object(listener_));
            check_signals();
            if (found == LayerQueue::Found::end)
                close();
            else if (found == LayerQueue::Found::layer) {
                ++taken_;
                return std::make_shared<SharedLayer>(std::move(layer), plan().rule);
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
    {
        const GilRelease released;
        queue_.close();
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
            cuts_.only(std::min(lowest, plan().layers.front().index), last + 1 + above, *mesh_, execution);
        const auto sliced = [&](const auto& wanted) {
            Plan some{{}, wider.rule, wider.snap_mm};
            std::copy_if(wider.layers.begin(), wider.layers.end(), std::back_inserter(some.layers), wanted);
            return some.layers.empty() ? std::vector<LayerPointer>()
                                       : lamella::python::sliced(mesh_->mesh(), some, execution, engine_);
        };
        return Beside{
            sliced([&](const PlannedLayer& layer) { return lowest <= layer.index && layer.index < first; }),
            sliced([&](const PlannedLayer& layer) { return layer.index > last; })};
    });
}

std::vector<LayerPointer> sliced(const Mesh& mesh, const Plan& plan, const Execution& execution,
                                 const Engine& engine) {
    std::vector<LayerPointer> layers;
    layers.reserve(plan.layers.size());
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        return [&, kept = std::make_shared<SharedLayer>(with_own_points(std::move(layer)),
                                                        plan.rule)]() mutable {
            layers.push_back(std::move(kept));
        };
    }};
    slice_to(sink, mesh, plan, {.execution = execution, .engine = engine});
    return layers;
}

} // namespace lamella::python
