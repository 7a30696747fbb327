#pragma once

// Threads for the duration of one computation. An algorithm may use the number of workers to divide its work,
// but its result must not depend on it.

#include "lamella/core/execution.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lamella {

/// Returns Execution::threads, or the number of processors available to this process if that is 0.
[[nodiscard]] unsigned thread_count(const Execution& execution) noexcept;

/// A team of workers. Worker 0 is the calling thread; the others are started at the first parallel region and
/// sleep between regions. If the execution runs tasks on threads of the caller, each worker is one of these
/// tasks, and workers may also run one after the other. If the system starts fewer threads than requested,
/// the team is smaller. Only the thread that created a team may use it, and parallel regions must not be
/// nested.
///
/// If the body throws, the others are asked to stop at their next chunk, and the first exception is rethrown
/// after all of them have returned.
class Executor {
  public:
    explicit Executor(const Execution& execution);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Returns the largest number of workers. A parallel region may have fewer.
    [[nodiscard]] unsigned workers() const noexcept { return workers_; }

    /// Calls body(worker) once for each worker, at the same time if there are threads for it.
    void run(const std::function<void(unsigned worker)>& body);

    /// Calls body(begin, end, worker) for consecutive chunks of [0, n) of at most `chunk`, which idle workers
    /// take in ascending order. A single chunk runs on the calling thread. Cancellation is checked before
    /// each chunk.
    void for_chunks(std::uint64_t n, std::uint64_t chunk,
                    const std::function<void(std::uint64_t begin, std::uint64_t end, unsigned worker)>& body);

    /// Throws Error{cancelled} after cancellation was requested.
    void check_cancelled() const;
    /// Returns true if this region should end early: cancellation was requested or another worker has thrown.
    [[nodiscard]] bool stopping() const noexcept {
        return failed_.load(std::memory_order_relaxed) || (cancel_ != nullptr && cancel_->requested());
    }

  private:
    void run_here(const std::function<void(unsigned worker)>& body);
    void run_as_tasks(const std::function<void(unsigned worker)>& body);
    void start_threads();
    void work(unsigned worker);
    void guarded(unsigned worker) noexcept;

    unsigned workers_;
    const CancelFlag* cancel_;
    std::function<void(unsigned, const std::function<void(unsigned)>&)>
        run_tasks_; ///< of the caller; may be empty
    std::vector<std::thread> threads_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable idle_;
    const std::function<void(unsigned)>* body_ = nullptr;
    std::uint64_t region_ = 0;
    unsigned running_ = 0;
    bool ending_ = false;
    std::atomic<bool> failed_{false};
    std::exception_ptr error_;
};

/// Counts the work done by all threads and reports it at most a hundred times, from one thread at a time.
class ProgressMeter {
  public:
    ProgressMeter(const Execution& execution, Stage stage, std::uint64_t total);

    /// Adds to the work done. Cheap; rethrows exceptions of the caller's progress function.
    void add(std::uint64_t amount);
    /// Reports the end. Must be called once, when the stage is complete.
    void finish();

  private:
    void report(std::uint64_t done);

    const std::function<void(const Progress&)>& callback_;
    Stage stage_;
    std::uint64_t total_;
    std::uint64_t step_;
    std::atomic<std::uint64_t> done_{0};
    std::mutex mutex_;
    std::uint64_t reported_ = 0;
};

} // namespace lamella
