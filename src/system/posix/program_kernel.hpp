#pragma once

// Functions for the program that POSIX does not offer. program_kernel_linux.cpp implements it for
// Linux, program_kernel_unix.cpp for macOS and other systems.

#include <csignal>
#include <cstdint>
#include <optional>

namespace lamella {

/// Opens a file that can be neither read nor written.
int open_placeholder() noexcept;
/// Returns whether an open descriptor is one of open_placeholder.
[[nodiscard]] bool is_placeholder(int descriptor) noexcept;

/// Returns the peak memory of this program in bytes.
[[nodiscard]] std::optional<std::uint64_t> peak_memory_of_program();

/// Returns a descriptor that becomes readable when one of the signals arrives, which must be blocked; -1 and
/// errno on failure.
[[nodiscard]] int open_signals(const sigset_t& signals) noexcept;
/// Takes the signals that have arrived.
void take_signals(int descriptor) noexcept;

/// Sends this process a signal when its parent process ends, if the system can.
void signal_when_parent_ends(int signal) noexcept;

void set_heap_thresholds(int own_pages, int kept) noexcept;

} // namespace lamella
