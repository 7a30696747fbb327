#pragma once

// Execution of long computations: number of threads, progress and cancellation.

#include "lamella/core/api.hpp"

#include <atomic>
#include <cstdint>
#include <functional>

LAMELLA_API_BEGIN
namespace lamella {

/// The stages from a mesh file to slice files, in the order in which they run.
enum class Stage { read, weld, link, slice, polygon, write };

/// Returns the name of a stage in progress lines and statistics, such as "link".
[[nodiscard]] const char* stage_name(Stage stage) noexcept;

/// Progress of a stage. `done` only increases until it equals `total` at the end of the stage. The unit
/// depends on the stage (bytes, triangles or layers). A stage that runs several times, for example once per
/// file or part, starts again from 0 each time.
struct Progress {
    Stage stage = Stage::read;
    std::uint64_t done = 0;
    std::uint64_t total = 0;
};

/// A request to end computations early, made from any thread or a signal handler. A request cannot be
/// withdrawn.
class CancelFlag {
  public:
    /// Makes a flag that also counts as requested if `outer` is. `outer` must outlive this flag.
    explicit CancelFlag(const CancelFlag* outer = nullptr) noexcept : outer_(outer) {}

    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool requested() const noexcept {
        return requested_.load(std::memory_order_relaxed) || (outer_ != nullptr && outer_->requested());
    }

  private:
    std::atomic<bool> requested_{false};
    const CancelFlag* outer_;
};

/// The largest number of threads that an Execution may ask for.
inline constexpr unsigned most_threads = 4096;

/// Parameters of every long computation. These parameters never change results: any number of threads gives
/// the same bytes.
struct Execution {
    /// Number of threads; 0 means one per processor available to this process. Fewer threads are used if the
    /// system cannot start all of them. Computations throw Error{usage} for more than `most_threads`.
    unsigned threads = 0;

    /// Runs tasks on threads of the caller, for example of a thread pool; Lamella then starts no threads.
    /// Must call task(i) once for each i < tasks, on any threads, at the same time or one after the other,
    /// and return when all of them have returned. It is called `threads` tasks at a time, and not from two
    /// threads at once by one computation. Otherwise Lamella starts threads of its own.
    std::function<void(unsigned tasks, const std::function<void(unsigned)>& task)> run_tasks = {};

    /// Called about ten to a hundred times per stage, from one thread at a time, but not always from the same
    /// thread. May throw: the computation stops and the exception reaches the caller.
    std::function<void(const Progress&)> progress = {};

    /// After a request the computation throws Error{ErrorKind::cancelled}, usually within a fraction of a
    /// second. Offsets, boolean operations and scan vectors stop even in the middle of a layer. Some readers
    /// and writers take longer to stop if files or layers are very large. The flag must outlive the
    /// computation; nullptr: not cancellable.
    const CancelFlag* cancel = nullptr;

    [[nodiscard]] bool cancelled() const noexcept { return cancel != nullptr && cancel->requested(); }
};

} // namespace lamella
LAMELLA_API_END
