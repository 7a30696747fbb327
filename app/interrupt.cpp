#include "interrupt.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string_view>
#include <system_error>

namespace lamella::app {
namespace {

constexpr int cancelled_exit_code = 130;
constexpr int patience_ms = 700;

int checked(int descriptor) {
    if (descriptor < 0)
        throw std::system_error(errno, std::generic_category(), "cannot watch for signals");
    return descriptor;
}

} // namespace

Interrupt::Interrupt() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    // Threads started later inherit the mask: the signals reach nobody but the descriptor.
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    signals_ = checked(signalfd(-1, &set, SFD_CLOEXEC));
    ending_ = checked(eventfd(0, EFD_CLOEXEC));
    watcher_ = std::thread([this] { watch(); });
}

Interrupt::~Interrupt() {
    const std::uint64_t one = 1;
    static_cast<void>(!write(ending_, &one, sizeof one));
    watcher_.join();
    close(signals_);
    close(ending_);
}

void Interrupt::watch() {
    std::array<pollfd, 2> awaited{pollfd{signals_, POLLIN, 0}, pollfd{ending_, POLLIN, 0}};
    while (poll(awaited.data(), awaited.size(), -1) < 0 && errno == EINTR) {
    }
    if (awaited[1].revents != 0)
        return;
    source_.request_stop();
    if (poll(&awaited[1], 1, patience_ms) == 0) {
        constexpr std::string_view text = "\nlamella: error: cancelled\n";
        static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));
        _exit(cancelled_exit_code);
    }
}

} // namespace lamella::app
