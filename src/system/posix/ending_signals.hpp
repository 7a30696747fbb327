#pragma once

#include <array>
#include <csignal>

namespace lamella {

/// Signals that end a program by default, and that others may send to it: Ctrl-\, the warnings of batch
/// systems before a time limit, timers that a caller left running. The interrupts of the user, after which
/// the program stops by itself, are not among them.
inline constexpr std::array ending_signals{SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF};

} // namespace lamella
