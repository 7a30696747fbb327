#pragma once

// What `remove_unfinished` needs of the system while the process ends: no locks, no memory.

#include <cstddef>

namespace lamella {

/// Removes a file, or a folder of files. Async-signal-safe where the system has signals.
void remove_at_once(const char* path) noexcept;
/// Waits for about a millisecond. Async-signal-safe where the system has signals.
void wait_a_moment() noexcept;

/// Holds the signals back from this thread that end the program and that others may send, where the system
/// has signals: that of used-up processor time and those of `ending_signals` in system/posix.
class EndingSignalHold {
  public:
    EndingSignalHold() noexcept;
    ~EndingSignalHold();
    EndingSignalHold(const EndingSignalHold&) = delete;
    EndingSignalHold& operator=(const EndingSignalHold&) = delete;

  private:
    alignas(std::max_align_t) std::byte before_[128]; ///< the signals that were held back before
};

} // namespace lamella
