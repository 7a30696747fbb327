#pragma once

// Ends of the program before its time: interrupts and crashes.

#include <cstdint>
#include <string_view>

namespace lamella {

/// Writes to standard error unless that would block. Async-signal-safe where the system has signals.
void write_last_words(std::string_view text) noexcept;
/// Ends the process without destructors.
[[noreturn]] void leave(int exit_code) noexcept;

/// Ends the program by the signal of a broken pipe, if standard output is a pipe whose reader has gone, as other
/// programs end whose reader wants no more. Returns otherwise, and if the signal was ignored when the program
/// started, or the system has none. Needs handle_crashes.
void end_by_broken_pipe() noexcept;

/// Calls `at_crash` when the program crashes or is ended by a signal that others send, other than the
/// interrupts of the user, before it ends as usual, and `at_time_limit` when the processor time is used up;
/// if that returns, the program ends as in a crash. Existing handlers, such as those of a sanitizer, are
/// kept. From then on, writing to a pipe without a reader, or to a file that becomes too large, is an error
/// and does not end the program.
void handle_crashes(void (*at_crash)() noexcept, void (*at_time_limit)() noexcept) noexcept;

/// Requests to end the program.
enum class Interrupts : std::uint8_t {
    of_user,  ///< Ctrl-C, the termination signal, the end of the terminal, unless ignored when the program
              ///< started
    of_owner, ///< from the process that started this one as a worker
};

/// Holds the interrupts of the user back from this thread and all threads that it starts, until there is an
/// InterruptWatch.
void block_interrupts() noexcept;

/// While this object exists, interrupts do not end the program. Must be created before any other thread that
/// could receive them. Throws std::system_error.
class InterruptWatch {
  public:
    explicit InterruptWatch(Interrupts kind);
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    static constexpr int for_ever = -1;
    enum class Event : std::uint8_t { interrupt, end, none };
    /// Waits for an interrupt or for `end`. Returns `end` if both have happened.
    [[nodiscard]] Event wait(int milliseconds) const noexcept;
    /// Waits for `end` only. Returns whether it has happened.
    [[nodiscard]] bool wait_for_end(int milliseconds) const noexcept;
    /// Forgets the interrupts so far, so that `wait` waits for further ones.
    void forget() noexcept;
    /// Ends all waiting.
    void end() noexcept;

  private:
    std::intptr_t interrupts_ = -1; ///< a descriptor or a handle, as `ending_`
    std::intptr_t ending_ = -1;
    std::intptr_t ending_input_ = -1; ///< the other end of a pipe, if `ending_` is one
};

} // namespace lamella
