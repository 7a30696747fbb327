#pragma once

// Ctrl-C, the termination signal, and the end of the terminal.

#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <csignal>
#include <latch>
#include <thread>

namespace lamella::app {

/// Returns SIGINT, SIGTERM and SIGHUP, except those that the program was started to ignore.
[[nodiscard]] sigset_t interrupts() noexcept;

/// Blocks these for this thread and all that it starts: earlier signals stay pending until there is an
/// Interrupt.
void block_interrupts();

/// During its lifetime these signals request cancelling instead of ending the program, so that temporary
/// files are removed. Must be created before any other thread. If the program is stuck (for example waiting
/// for standard input) a short while after the signal, or if another signal arrives, its temporary files are
/// removed and it is ended at once with exit code 130.
///
/// Between the end of the constructor and a signal, its thread only waits, so the process may be forked.
class Interrupt {
  public:
    explicit Interrupt(const Messages& messages, const sigset_t& signals = interrupts());
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    [[nodiscard]] const CancelFlag& flag() const noexcept { return flag_; }

  private:
    void watch();

    const Messages& messages_;
    CancelFlag flag_;
    int signals_ = -1; ///< becomes readable when a signal arrives
    int ending_ = -1;  ///< becomes readable when the watcher is no longer needed
    std::latch watching_{1};
    std::thread watcher_;
};

} // namespace lamella::app
