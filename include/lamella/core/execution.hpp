#pragma once

// How a long computation runs: on how many threads, who is told, and how it is stopped.

#include "lamella/core/api.hpp"

#include <atomic>
#include <cstdint>
#include <functional>

LAMELLA_API_BEGIN
namespace lamella {

/// The stages of the way from a file to slice files, in the order in which they run.
enum class Stage { read, weld, link, slice, polygon, write };

/// The stage's name as users meet it in progress lines and statistics, such as "link".
[[nodiscard]] const char* stage_name(Stage stage) noexcept;

/// How far a stage has come. `done` does not fall before it has reached `total`, at the end of the stage; the
/// unit is the stage's own (bytes, triangles or layers). A stage that runs several times, as for each of
/// several files or parts, begins anew each time.
struct Progress {
    Stage stage = Stage::read;
    std::uint64_t done = 0;
    std::uint64_t total = 0;
};

/// A request to end computations early, made from any thread or a signal handler, and never taken back.
class CancelFlag {
  public:
    /// `outer`: a request made there is one here, too. It must live longer.
    explicit CancelFlag(const CancelFlag* outer = nullptr) noexcept : outer_(outer) {}

    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool requested() const noexcept {
        return requested_.load(std::memory_order_relaxed) || (outer_ != nullptr && outer_->requested());
    }

  private:
    std::atomic<bool> requested_{false};
    const CancelFlag* outer_;
};

/// Handed to every long computation. Results never depend on it: any number of threads gives the same bytes.
struct Execution {
    /// Threads to use; 0 means one per processor available to this process. Fewer are used where the system
    /// lets no more be started.
    unsigned threads = 0;

    /// Called now and then (some ten to a hundred times per stage), from one thread at a time, but not always
    /// the same one. May throw: the computation stops and the exception reaches the caller.
    std::function<void(const Progress&)> progress = {};

    /// Once this is requested the computation ends with Error{ErrorKind::cancelled} at its next step:
    /// usually within a fraction of a second; the work on one layer, and some readers, cannot be interrupted,
    /// so very large ones take longer. The flag must outlive the computation;
    /// nullptr: nobody will ask.
    const CancelFlag* cancel = nullptr;

    [[nodiscard]] bool cancelled() const noexcept { return cancel != nullptr && cancel->requested(); }
};

} // namespace lamella
LAMELLA_API_END
