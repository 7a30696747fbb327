#include "crash.hpp"

#include "lamella/core/unfinished.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace lamella::app {
namespace {

constexpr std::string_view lost_input =
    "\nlamella: error: a file became shorter while it was read, or its disk failed\n";

// A handler of signals can be given nothing.
volatile std::sig_atomic_t silent = 0;

extern "C" void at_crash(int number) {
    remove_unfinished();
    if (number == SIGBUS) {
        if (silent == 0)
            static_cast<void>(!write(STDERR_FILENO, lost_input.data(), lost_input.size()));
        _exit(lost_input_exit_code);
    }
    raise(number); // with its default action again, once this handler is left
}

} // namespace

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

void be_silent_at_crashes() noexcept {
    silent = 1;
}

} // namespace lamella::app
