#pragma once

// Accepts layers in any order and runs the sink's actions in ascending order, with a bound on how far ahead
// workers may run.

#include "lamella/contour/layer.hpp"
#include "lamella/slicing/slice.hpp"

#include "core/executor.hpp"

#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

namespace lamella {

/// Hands layers to a sink. The parallel part of the sink runs on the calling thread. Its ordered parts run
/// one at a time in plane order, on the thread that brings the next layer in order.
class OrderedDelivery {
  public:
    OrderedDelivery(const LayerSink& sink, const Executor& executor, ProgressMeter& progress)
        : sink_(sink), executor_(executor), progress_(progress) {}

    /// Delivers the layer at position `plane` of the plan. Each layer must be delivered once. Thread-safe.
    void deliver(std::uint32_t plane, Layer&& layer) {
        std::function<void()> action = sink_(std::move(layer));
        std::unique_lock lock(mutex_);
        assert(plane >= next_ && !waiting_.contains(plane)); // no layer is delivered twice
        waiting_.emplace(plane, std::move(action));
        if (draining_)
            return; // the draining thread will run it
        draining_ = true;
        try {
            while (!waiting_.empty() && waiting_.begin()->first == next_) {
                const std::function<void()> ready = std::move(waiting_.begin()->second);
                waiting_.erase(waiting_.begin());
                lock.unlock();
                if (ready)
                    ready();
                progress_.add(1);
                lock.lock();
                ++next_;
                moved_.notify_all();
            }
        } catch (...) {
            if (!lock.owns_lock())
                lock.lock();
            failed_ = true;
            moved_.notify_all();
            throw;
        }
        draining_ = false;
    }

    /// Waits until all planes before `plane` are delivered. Returns false if slicing stops.
    [[nodiscard]] bool wait_for(std::uint32_t plane) {
        std::unique_lock lock(mutex_);
        while (next_ < plane) {
            if (failed_ || executor_.stopping())
                return false;
            moved_.wait_for(lock, std::chrono::milliseconds(50)); // a stop request does not notify
        }
        return true;
    }

    /// Returns the number of layers that the sink has finished. Must not be called during a delivery.
    [[nodiscard]] std::uint32_t delivered() const noexcept { return next_; }

  private:
    const LayerSink& sink_;
    const Executor& executor_;
    ProgressMeter& progress_;
    std::mutex mutex_;
    std::condition_variable moved_;
    std::map<std::uint32_t, std::function<void()>> waiting_;
    std::uint32_t next_ = 0;
    bool draining_ = false;
    bool failed_ = false;
};

} // namespace lamella
