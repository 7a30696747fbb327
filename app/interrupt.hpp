#pragma once

// Ctrl-C, the terminate signal, and the end of the terminal.

#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <csignal>
#include <latch>
#include <thread>

namespace lamella::app {

/// SIGINT, SIGTERM and SIGHUP, but for those that the program was started to ignore.
[[nodiscard]] sigset_t interrupts() noexcept;

/// Keeps these from this thread and all that it starts: what comes before there is an Interrupt waits for it.
void block_interrupts();

/// While it lives, these signals request cancelling instead of ending the program, so that temporary files
/// are removed. To be made before any other thread. Should the program be stuck (such as waiting for standard
/// input) a short while after the signal, or should another signal come, its temporary files are removed for
/// it and it is ended at once with exit code 130.
///
/// Its thread does nothing but wait, from the end of the constructor until a signal: the process may be
/// forked.
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
