#include "system/program_ending.hpp"

#include "system/posix/ending_signals.hpp"
#include "system/posix/program_kernel.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <span>
#include <system_error>

namespace lamella {

namespace {

// Global, because a signal handler has no parameter for them.
void (*crashed)() noexcept = nullptr;
void (*time_is_up)() noexcept = nullptr;
// The action for a broken pipe when the program started.
bool broken_pipes_are_ignored = true;

extern "C" void at_crash_signal(int number) {
    if (number == SIGXCPU)
        time_is_up();
    crashed();
    raise(number); // the default action follows when this handler returns
}

/// Returns whether a signal has its default action, or none, instead of a handler.
bool has_action(int number, void (*action)(int)) {
    struct sigaction before {};
    return ::sigaction(number, nullptr, &before) == 0 && (before.sa_flags & SA_SIGINFO) == 0 &&
           before.sa_handler == action;
}

/// Waits for any of the descriptors. Returns the number of ready ones; 0 after the time is up.
int wait_for(std::span<pollfd> awaited, int milliseconds) noexcept {
    int ready = 0;
    do
        ready = ::poll(awaited.data(), static_cast<nfds_t>(awaited.size()), milliseconds);
    while (ready < 0 && errno == EINTR);
    return ready;
}

sigset_t signals_of(Interrupts kind) noexcept {
    sigset_t set;
    sigemptyset(&set);
    if (kind == Interrupts::of_owner) {
        sigaddset(&set, SIGUSR1);
        return set;
    }
    // A parent process, such as nohup, may have made this program ignore signals.
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        if (!has_action(number, SIG_IGN))
            sigaddset(&set, number);
    return set;
}

} // namespace

void write_last_words(std::string_view text) noexcept {
    pollfd error_output{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&error_output, 1, 0) > 0)
        static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
}

void leave(int exit_code) noexcept {
    ::_exit(exit_code);
}

void end_by_broken_pipe() noexcept {
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    if (broken_pipes_are_ignored || ::poll(&output, 1, 0) <= 0 || (output.revents & POLLERR) == 0)
        return;
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
}

void handle_crashes(void (*at_crash)() noexcept, void (*at_time_limit)() noexcept) noexcept {
    crashed = at_crash;
    time_is_up = at_time_limit;
    broken_pipes_are_ignored = !has_action(SIGPIPE, SIG_DFL);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    const auto handle = [](int number) {
        if (!has_action(number, SIG_DFL))
            return;
        struct sigaction action {};
        action.sa_handler = at_crash_signal;
        action.sa_flags = SA_RESETHAND;
        ::sigaction(number, &action, nullptr);
    };
    for (const int number : {SIGBUS, SIGSEGV, SIGILL, SIGFPE, SIGABRT, SIGXCPU})
        handle(number);
    for (const int number : ending_signals)
        handle(number);
}

void block_interrupts() noexcept {
    const sigset_t set = signals_of(Interrupts::of_user);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

InterruptWatch::InterruptWatch(Interrupts kind) {
    // Threads started later inherit the mask, so only the descriptor receives the signals.
    const sigset_t signals = signals_of(kind);
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    // A byte written to one end of the pipe ends all waiting at the other.
    std::array<int, 2> ends{-1, -1};
    interrupts_ = open_signals(signals);
    if (interrupts_ < 0 || ::pipe(ends.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot watch for signals");
    for (const int end : ends)
        ::fcntl(end, F_SETFD, FD_CLOEXEC);
    ending_ = ends[0];
    ending_input_ = ends[1];
}

InterruptWatch::~InterruptWatch() {
    for (const std::intptr_t descriptor : {interrupts_, ending_, ending_input_})
        ::close(static_cast<int>(descriptor));
}

InterruptWatch::Event InterruptWatch::wait(int milliseconds) const noexcept {
    std::array<pollfd, 2> awaited{pollfd{static_cast<int>(interrupts_), POLLIN, 0},
                                  pollfd{static_cast<int>(ending_), POLLIN, 0}};
    wait_for(awaited, milliseconds);
    return awaited[1].revents != 0 ? Event::end : awaited[0].revents != 0 ? Event::interrupt : Event::none;
}

bool InterruptWatch::wait_for_end(int milliseconds) const noexcept {
    pollfd ending{static_cast<int>(ending_), POLLIN, 0};
    return wait_for({&ending, 1}, milliseconds) > 0;
}

void InterruptWatch::forget() noexcept {
    take_signals(static_cast<int>(interrupts_));
}

void InterruptWatch::end() noexcept {
    static_cast<void>(!::write(static_cast<int>(ending_input_), "", 1));
}

} // namespace lamella
