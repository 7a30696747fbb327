#pragma once

// What `remove_unfinished` needs of the system while the process ends: no locks, no memory.

#include <cstddef>

namespace lamella {

/// Removes a file, or a folder of files. Async-signal-safe where the system has signals.
void remove_at_once(const char* path) noexcept;
/// Waits for about a millisecond. Async-signal-safe where the system has signals.
void wait_a_moment() noexcept;

/// Holds the signal of used-up processor time back from this thread, where the system has signals.
class TimeSignalHold {
  public:
    TimeSignalHold() noexcept;
    ~TimeSignalHold();
    TimeSignalHold(const TimeSignalHold&) = delete;
    TimeSignalHold& operator=(const TimeSignalHold&) = delete;

  private:
    alignas(std::max_align_t) std::byte before_[128]; ///< the signals that were held back before
};

} // namespace lamella
