#include "system/ending.hpp"

#include "system/posix/ending_signals.hpp"
#include "system/posix/kernel.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <ctime>
#include <new>

namespace lamella {

namespace {

// Empties the folder once and removes it; returns false if entries have been added in the meantime.
bool remove_emptied(const char* path) noexcept {
    const int folder = ::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0)
        return true;
    unlink_entries(folder);
    ::close(folder);
    return ::rmdir(path) == 0 || errno != ENOTEMPTY;
}

} // namespace

void remove_at_once(const char* path) noexcept {
    if (::unlink(path) == 0 || (errno != EISDIR && errno != EPERM))
        return;
    // Unlinking entries while a folder is listed may hide others.
    constexpr int most_attempts = 100;
    for (int attempt = 0; attempt < most_attempts && !remove_emptied(path); ++attempt) {
    }
}

void wait_a_moment() noexcept {
    constexpr timespec a_moment{.tv_sec = 0, .tv_nsec = 1'000'000};
    ::nanosleep(&a_moment, nullptr);
}

EndingSignalHold::EndingSignalHold() noexcept {
    static_assert(sizeof(sigset_t) <= sizeof before_);
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, SIGXCPU);
    for (const int number : ending_signals)
        sigaddset(&held, number);
    ::pthread_sigmask(SIG_BLOCK, &held, new (before_) sigset_t);
}

EndingSignalHold::~EndingSignalHold() {
    ::pthread_sigmask(SIG_SETMASK, std::launder(reinterpret_cast<const sigset_t*>(before_)), nullptr);
}

} // namespace lamella
