#include "system/posix/program_kernel.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>

namespace lamella {

int open_placeholder() noexcept {
    return ::open("/", O_PATH | O_DIRECTORY); // exists on every system
}

bool is_placeholder(int descriptor) noexcept {
    return (::fcntl(descriptor, F_GETFL) & O_PATH) != 0;
}

std::optional<std::uint64_t> peak_memory_of_program() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        constexpr std::string_view key = "VmHWM:";
        if (line.starts_with(key))
            return std::stoull(line.substr(key.size())) * 1024;
    }
    return std::nullopt;
}

int open_signals(const sigset_t& signals) noexcept {
    return ::signalfd(-1, &signals, SFD_CLOEXEC);
}

void take_signals(int descriptor) noexcept {
    std::array<signalfd_siginfo, 8> signals{};
    static_cast<void>(!::read(descriptor, signals.data(), sizeof signals));
}

void signal_when_parent_ends(int signal) noexcept {
    ::prctl(PR_SET_PDEATHSIG, signal);
}

void set_heap_thresholds(int own_pages, int kept) noexcept {
    ::mallopt(M_MMAP_THRESHOLD, own_pages);
    ::mallopt(M_TRIM_THRESHOLD, kept);
}

} // namespace lamella
