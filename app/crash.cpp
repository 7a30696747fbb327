#include "crash.hpp"

#include "lamella/core/whole_file.hpp"

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace lamella::app {
namespace {

// A handler of signals can be given nothing, and may ask for no memory.
std::atomic<ProgressStyle> told_as = ProgressStyle::none;

std::string_view lost_input() noexcept {
    switch (told_as) {
    case ProgressStyle::silent:
        return {};
    case ProgressStyle::json:
        return "\n{\"error\":\"a file became shorter while it was read, or its disk "
               "failed\",\"exit_code\":3}\n";
    default:
        return "\nlamella: error: a file became shorter while it was read, or its disk failed\n";
    }
}

extern "C" void at_crash(int number) {
    if (number == SIGBUS)
        leave_at_once(lost_input(), lost_input_exit_code);
    remove_unfinished();
    raise(number); // with its default action again, once this handler is left
}

} // namespace

void leave_at_once(std::string_view last_words, int exit_code) noexcept {
    remove_unfinished();
    // What is stuck may be a write to standard error: nobody reads it, or not soon enough.
    pollfd error_output{STDERR_FILENO, POLLOUT, 0};
    if (poll(&error_output, 1, 0) > 0)
        static_cast<void>(!write(STDERR_FILENO, last_words.data(), last_words.size()));
    _exit(exit_code);
}

void prepare_for_crashes() noexcept {
    // A reader that went away and a file that grew too large are errors of writing, not ends of the program.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int number : {SIGBUS, SIGSEGV, SIGILL, SIGFPE, SIGABRT}) {
        struct sigaction before {};
        if (sigaction(number, nullptr, &before) != 0 || (before.sa_flags & SA_SIGINFO) != 0 ||
            before.sa_handler != SIG_DFL)
            continue;
        struct sigaction action {};
        action.sa_handler = at_crash;
        action.sa_flags = SA_RESETHAND;
        sigaction(number, &action, nullptr);
    }
}

void tell_crashes(ProgressStyle style) noexcept {
    told_as = style;
}

} // namespace lamella::app
