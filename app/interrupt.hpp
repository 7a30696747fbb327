#pragma once

// Handles Ctrl-C, the termination signal, and the end of the terminal.

#include "lamella/core/execution.hpp"

#include "messages.hpp"
#include "system/program_ending.hpp"

#include <future>
#include <thread>

namespace lamella::app {

/// While this object exists, interrupts request cancellation instead of ending the program, so that
/// temporary files are removed. Must be created before any other thread. If the program has not ended a short
/// while after the signal (for example because it waits for standard input), or if another signal arrives,
/// its temporary files are removed and it is ended at once with exit code 130.
///
/// Its thread only waits between the end of the constructor and a signal, so the process may be forked.
class Interrupt {
  public:
    explicit Interrupt(const Messages& messages, Interrupts kind = Interrupts::of_user);
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    [[nodiscard]] const CancelFlag& flag() const noexcept { return flag_; }

  private:
    void watch();

    const Messages& messages_;
    CancelFlag flag_;
    InterruptWatch watch_;
    std::promise<void> watching_;
    std::thread watcher_;
};

} // namespace lamella::app
