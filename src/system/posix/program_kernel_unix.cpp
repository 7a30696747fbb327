#include "system/posix/program_kernel.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace lamella {

namespace {

int signals_end = -1; // for the handler, which has no parameter for it

extern "C" void note_signal(int /*number*/) {
    const int before = errno;
    static_cast<void>(!::write(signals_end, "", 1));
    errno = before;
}

} // namespace

int open_placeholder() noexcept {
    return ::open("/", O_RDONLY | O_DIRECTORY); // reading and writing a folder fails
}

bool is_placeholder(int descriptor) noexcept {
    struct stat status {};
    return ::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode);
}

std::optional<std::uint64_t> peak_memory_of_program() {
    return std::nullopt;
}

int open_signals(const sigset_t& signals) noexcept {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0)
        return -1;
    for (const int end : ends)
        ::fcntl(end, F_SETFD, FD_CLOEXEC);
    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
    signals_end = ends[1];
    for (int number = 1; number < NSIG; ++number)
        if (sigismember(&signals, number) == 1) {
            struct sigaction action {};
            action.sa_handler = note_signal;
            action.sa_flags = SA_RESTART;
            ::sigaction(number, &action, nullptr);
        }
    ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    return ends[0];
}

void take_signals(int descriptor) noexcept {
    std::array<char, 64> signals{};
    static_cast<void>(!::read(descriptor, signals.data(), signals.size()));
}

void signal_when_parent_ends(int /*signal*/) noexcept {}

void set_heap_thresholds(int /*own_pages*/, int /*kept*/) noexcept {}

} // namespace lamella
