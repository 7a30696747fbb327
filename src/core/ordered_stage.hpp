#pragma once

// Accepts planes in any order and calls their commits in ascending order, and completions on all threads.
// Workers can wait here, so that they do not get too far ahead.

#include "lamella/core/commit.hpp"

#include "core/executor.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

namespace lamella {

/// Calls the commits of planes one at a time and in the order of planes, and their completions on all
/// threads. The thread that delivers the next plane in order calls the commits that are then due, and
/// afterwards the completions, its own first. Before a thread continues with another plane, it calls all
/// completions that are due, so that few of them wait. Nothing is called once the executor is stopping.
class OrderedStage {
  public:
    OrderedStage(const Executor& executor, ProgressMeter& progress)
        : executor_(executor), progress_(progress) {}

    /// Delivers the plane at this position of the plan. Each plane must be delivered once. The commit may be
    /// empty. Thread-safe.
    void deliver(std::uint64_t plane, Commit commit) {
        std::unique_lock lock(mutex_);
        assert(plane >= next_ && !waiting_.contains(plane)); // no layer is delivered twice
        waiting_.emplace(plane, std::move(commit));
        if (!draining_) // otherwise the draining thread will run it
            drain(lock);
        complete(lock);
    }

    /// Waits until all planes before `plane` are delivered. Returns false if slicing stops.
    [[nodiscard]] bool wait_for(std::uint64_t plane) {
        std::unique_lock lock(mutex_);
        while (next_ < plane) {
            if (failed_ || executor_.stopping())
                return false;
            if (complete(lock))
                continue;
            moved_.wait_for(lock, std::chrono::milliseconds(50)); // a stop request does not notify
        }
        return true;
    }

    /// Returns the number of planes that are committed. Must not be called during a delivery.
    [[nodiscard]] std::uint64_t delivered() const noexcept { return next_; }

  private:
    /// Calls the commits that are due. The lock is released during each call.
    void drain(std::unique_lock<std::mutex>& lock) {
        draining_ = true;
        try {
            while (!waiting_.empty() && waiting_.begin()->first == next_ && !executor_.stopping()) {
                const Commit ready = std::move(waiting_.begin()->second);
                waiting_.erase(waiting_.begin());
                lock.unlock();
                Completions after;
                if (ready)
                    ready.in_order(after);
                progress_.add(1);
                lock.lock();
                completions_.insert(completions_.end(), std::make_move_iterator(after.begin()),
                                    std::make_move_iterator(after.end()));
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

    /// Calls completions until none are left, and returns whether there were any. The lock is released during
    /// each call.
    bool complete(std::unique_lock<std::mutex>& lock) {
        bool any = false;
        while (!completions_.empty() && !executor_.stopping()) {
            any = true;
            const std::function<void()> completion = std::move(completions_.front());
            completions_.pop_front();
            lock.unlock();
            completion();
            lock.lock();
        }
        return any;
    }

    const Executor& executor_;
    ProgressMeter& progress_;
    std::mutex mutex_;
    std::condition_variable moved_;
    std::map<std::uint64_t, Commit> waiting_;
    std::deque<std::function<void()>> completions_;
    std::uint64_t next_ = 0;
    bool draining_ = false;
    bool failed_ = false;
};

/// Calls prepare(i) for each i of [0, n) on all workers, and the commits that it returns in ascending order.
/// Each worker is at most one item ahead: no more than `workers` results wait. Throws the errors of both, and
/// Error{cancelled}.
template <class Prepare>
void run_in_order(Executor& executor, ProgressMeter& progress, std::uint64_t n, const Prepare& prepare) {
    OrderedStage stage(executor, progress);
    executor.for_chunks(n, 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        if (stage.wait_for(i + 1 - std::min<std::uint64_t>(i + 1, executor.workers())))
            stage.deliver(i, prepare(i));
    });
    executor.check_cancelled();
}

} // namespace lamella
