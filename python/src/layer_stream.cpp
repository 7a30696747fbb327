#include "layer_stream.hpp"

#include "lamella/core/error.hpp"

#include "unlocked.hpp"

#include <memory>
#include <utility>

namespace py = pybind11;

namespace lamella::python {
namespace {

// Enough for the threads not to wait for each other, little enough not to be felt: 16 MB.
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

LayerStream::LayerStream(MeshPointer mesh, Plan plan, const Engine& with, unsigned threads,
                         py::object listener)
    : mesh_(std::move(mesh)), plan_(std::move(plan)), listener_(std::move(listener)) {
    Execution execution{.threads = threads, .cancel = &queue_.closed()};
    if (!listener_.is_none())
        execution.progress = [this](const Progress& progress) {
            progress_.put(progress);
        };
    worker_ = std::thread([this, execution, &with] {
        std::exception_ptr failure;
        try {
            const LayerSink sink = [&](Layer&& layer) -> std::function<void()> {
                return [this, kept = std::move(layer)]() mutable {
                    queue_.put(std::move(kept));
                };
            };
            slice_to(sink, mesh_->mesh(), plan_, execution, nullptr, with);
        } catch (...) {
            failure = std::current_exception();
        }
        queue_.end(std::move(failure));
    });
}

// To join a worker that nobody else has does not fail.
LayerStream::~LayerStream() { // NOLINT(bugprone-exception-escape)
    close();
}

LayerPointer LayerStream::next() {
    try {
        for (Layer layer; !closed_;) {
            LayerQueue::Found found = LayerQueue::Found::nothing_yet;
            {
                const Unlocked released;
                found = queue_.take(layer);
            }
            // A copy, since whoever is called may close the stream, which forgets its listener.
            tell(progress_, py::object(listener_));
            check_signals();
            if (found == LayerQueue::Found::end)
                close();
            else if (found == LayerQueue::Found::layer) {
                ++taken_;
                return std::make_shared<SharedLayer>(std::move(layer));
            }
        }
    } catch (
        const py::error_already_set&) { // of the listener, which may have closed it, too, or an interrupt
        close();
        throw;
    } catch (...) {
        if (closed_) // by another thread, meanwhile
            throw py::stop_iteration();
        close();
        throw;
    }
    throw py::stop_iteration();
}

void LayerStream::close() {
    closed_ = true;
    // Of several threads that close it, one gets the worker.
    std::thread worker = std::move(worker_);
    {
        const Unlocked released;
        queue_.close();
        if (worker.joinable())
            worker.join();
    }
    forget_listener();
}

double LayerStream::bottom() const {
    if (left() == 0)
        throw Error(ErrorKind::usage, "no layers are left: the stream is closed or at its end");
    return plan_.layers[taken_].bottom;
}

} // namespace lamella::python
