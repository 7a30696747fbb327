#include "system/program_start.hpp"

#include "system/posix/program_kernel.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>

namespace lamella {

std::vector<std::string> program_arguments(int argc, char** argv) {
    return {argv + 1, argv + argc};
}

void prepare_standard_streams() noexcept {
    // Each call of open returns the lowest free number.
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(number, F_GETFD) < 0)
            open_placeholder();
}

bool output_is_closed() noexcept {
    return ::fcntl(STDOUT_FILENO, F_GETFL) < 0 || is_placeholder(STDOUT_FILENO);
}

bool errors_are_on_terminal() noexcept {
    return ::isatty(STDERR_FILENO) != 0;
}

int read_text(const std::string& path, std::string& text) {
    // Standard input is read by its descriptor, because some files, such as a socket, cannot be opened by
    // name.
    const int descriptor = path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return errno;
    std::array<char, 1 << 16> block;
    int failed = 0;
    for (;;) {
        const ssize_t got = ::read(descriptor, block.data(), block.size());
        if (got == 0)
            break;
        if (got > 0) {
            text.append(block.data(), static_cast<std::size_t>(got));
        } else if (errno == EINTR || errno == EAGAIN) {
            pollfd waiting{descriptor, POLLIN, 0}; // an inherited descriptor may be non-blocking
            ::poll(&waiting, 1, -1);
        } else {
            failed = errno;
            break;
        }
    }
    ::close(descriptor);
    return failed;
}

std::optional<FileIdentity> identity_of(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        return std::nullopt;
    return FileIdentity{static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino)};
}

std::uint64_t peak_memory() {
    if (const auto peak = peak_memory_of_program())
        return *peak;
    // Includes the process that started this one.
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

void set_heap(int own_pages, int kept) noexcept {
    set_heap_thresholds(own_pages, kept);
}

std::size_t longest_path() noexcept {
    return PATH_MAX;
}

} // namespace lamella
