#include "crash.hpp"

#include "lamella/system/whole_file.hpp"

#include "failure.hpp"

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace lamella::app {
namespace {

// Global, because a signal handler has no parameter for it; atomic, because it runs at any time.
std::atomic<ProgressStyle> told_as = ProgressStyle::none;

// Begins with a line break, because a progress bar may be on the current line.
constexpr std::string_view time_is_up =
    "\nlamella: error: the processor time that a process may take is used up (see ulimit -t)\n";
constexpr std::string_view time_is_up_json =
    "{\"error\":\"the processor time that a process may take is used up (see ulimit "
    "-t)\",\"exit_code\":5}\n";

extern "C" void at_crash(int number) {
    const ProgressStyle style = told_as;
    if (number == SIGXCPU && style != ProgressStyle::silent)
        leave_at_once(style == ProgressStyle::json ? time_is_up_json : time_is_up, limit_exit_code);
    remove_unfinished();
    raise(number); // the default action follows when this handler returns
}

} // namespace

void leave_at_once(std::string_view last_words, int exit_code) noexcept {
    remove_unfinished();
    // A blocked write to standard error may be the reason why the program is stuck.
    pollfd error_output{STDERR_FILENO, POLLOUT, 0};
    if (poll(&error_output, 1, 0) > 0)
        static_cast<void>(!write(STDERR_FILENO, last_words.data(), last_words.size()));
    _exit(exit_code);
}

void prepare_for_crashes() noexcept {
    // A closed pipe and a file that became too large are errors of writing; they must not end the program.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int number : {SIGBUS, SIGSEGV, SIGILL, SIGFPE, SIGABRT, SIGXCPU}) {
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

void report_crashes(ProgressStyle style) noexcept {
    told_as = style;
}

} // namespace lamella::app
