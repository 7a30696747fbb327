#pragma once

// Threads for the length of one computation. Parallelism is handed in and leaves no trace in the result: an
// algorithm may use the number of workers to split its work, never to decide its answer.

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

/// Threads that Execution::threads asks for: itself, or the processors this process may use.
[[nodiscard]] unsigned thread_count(const Execution& execution) noexcept;

/// A team of workers. Worker 0 is the calling thread; the others are started at the first parallel region and
/// sleep between regions. Where the system gives fewer threads than were asked for, the team is those that
/// there are. A team belongs to the thread that made it; regions do not nest.
///
/// When the body throws, the others are asked to stop at their next chunk, and the first exception is
/// rethrown after all of them have returned.
class Executor {
  public:
    explicit Executor(const Execution& execution);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// How many there are. A parallel region may find that there are fewer; never more.
    [[nodiscard]] unsigned workers() const noexcept { return workers_; }

    /// body(worker) once for each worker, at the same time.
    void run(const std::function<void(unsigned worker)>& body);

    /// body(begin, end, worker) over [0, n) in chunks of at most `chunk`, handed out in ascending order to
    /// whoever is free. Fewer than two chunks run on the calling thread. Checks for cancellation at each
    /// chunk.
    void for_chunks(std::uint64_t n, std::uint64_t chunk,
                    const std::function<void(std::uint64_t begin, std::uint64_t end, unsigned worker)>& body);

    /// Throws Error{cancelled} once cancelling was requested.
    void check_cancelled() const;
    /// True when this region should end early: cancelling was requested or another worker has thrown.
    [[nodiscard]] bool stopping() const noexcept {
        return failed_.load(std::memory_order_relaxed) || (cancel_ != nullptr && cancel_->requested());
    }

  private:
    void start_threads();
    void work(unsigned worker);
    void guarded(unsigned worker) noexcept;

    unsigned workers_;
    const CancelFlag* cancel_;
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

/// Counts work done from any thread and reports it at most a hundred times, from one thread at a time.
class ProgressMeter {
  public:
    ProgressMeter(const Execution& execution, Stage stage, std::uint64_t total);

    /// Adds to the work done. Cheap; may throw what the caller's progress function throws.
    void add(std::uint64_t amount);
    /// Reports the end. To be called once, when the stage is complete.
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
