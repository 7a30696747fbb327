#include "interrupt.hpp"

#include "crash.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <new>
#include <span>
#include <string>
#include <system_error>

namespace lamella::app {
namespace {

constexpr int cancelled_exit_code = 130;
constexpr int patience_ms = 700;
constexpr int together_ms = 200; // some programs signal a process and then its group; both signals count as
                                 // one

int checked(int descriptor) {
    if (descriptor < 0)
        throw std::system_error(errno, std::generic_category(), "cannot watch for signals");
    return descriptor;
}

/// Returns whether the parent process, such as nohup, made this program ignore the signal.
bool is_ignored(int number) {
    struct sigaction action {};
    return sigaction(number, nullptr, &action) == 0 && (action.sa_flags & SA_SIGINFO) == 0 &&
           action.sa_handler == SIG_IGN;
}

/// Waits for any of the descriptors. Returns the number of ready ones; 0 after the time is up.
int wait_for(std::span<pollfd> awaited, int milliseconds) {
    int ready = 0;
    do {
        ready = poll(awaited.data(), awaited.size(), milliseconds);
    } while (ready < 0 && errno == EINTR);
    return ready;
}

} // namespace

sigset_t interrupts() noexcept {
    sigset_t set;
    sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(number))
            sigaddset(&set, number);
    return set;
}

void block_interrupts() {
    const sigset_t set = interrupts();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

Interrupt::Interrupt(const Messages& messages, const sigset_t& signals) : messages_(messages) {
    // Threads started later inherit the mask, so only the descriptor receives the signals.
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    signals_ = checked(signalfd(-1, &signals, SFD_CLOEXEC));
    ending_ = checked(eventfd(0, EFD_CLOEXEC));
    watcher_ = std::thread([this] { watch(); });
    // Wait until the thread has started. While it starts, it may hold locks of the allocator, and a fork of
    // the process would copy these in the locked state.
    watching_.wait();
}

Interrupt::~Interrupt() {
    const std::uint64_t one = 1;
    static_cast<void>(!write(ending_, &one, sizeof one));
    watcher_.join();
    close(signals_);
    close(ending_);
}

void Interrupt::watch() {
    watching_.count_down();
    std::array<pollfd, 2> awaited{pollfd{signals_, POLLIN, 0}, pollfd{ending_, POLLIN, 0}};
    wait_for(awaited, -1);
    if (awaited[1].revents != 0)
        return;
    flag_.request();
    std::string words;
    try {
        words = messages_.last_words("cancelled", cancelled_exit_code);
    } catch (const std::bad_alloc&) { // there is then no message
    }
    wait_for(std::span(awaited).last(1), together_ms);
    std::array<signalfd_siginfo, 8> first{};
    static_cast<void>(!read(signals_, first.data(), sizeof first)); // so that a second signal can be detected
    if (awaited[1].revents == 0)
        wait_for(awaited, patience_ms - together_ms);
    if (awaited[1].revents == 0)
        leave_at_once(words, cancelled_exit_code);
}

} // namespace lamella::app
