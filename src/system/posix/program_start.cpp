#include "system/program_start.hpp"

#include "system/posix/program_kernel.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <string_view>

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

std::optional<unsigned> terminal_columns() noexcept {
    if (::isatty(STDERR_FILENO) == 0)
        return std::nullopt;
    constexpr unsigned usual = 80;
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

std::optional<unsigned> output_columns() noexcept {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
        return std::nullopt;
    return size.ws_col;
}

std::optional<std::vector<std::string>> files_matching(const std::string& /*pattern*/) {
    return std::nullopt; // shells replace patterns
}

void keep_window_open() {}

int read_text(const std::string& path, std::string& text, std::uint64_t most) {
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
            if (static_cast<std::uint64_t>(got) > most - text.size()) {
                failed = EFBIG;
                break;
            }
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
#ifdef __APPLE__
    constexpr std::uint64_t unit = 1;
#else
    constexpr std::uint64_t unit = 1024;
#endif
    return static_cast<std::uint64_t>(usage.ru_maxrss) * unit;
}

void set_heap(int own_pages, int kept) noexcept {
    set_heap_thresholds(own_pages, kept);
}

std::size_t longest_path() noexcept {
    return PATH_MAX;
}

std::string quoted_for_shell(const std::string& path) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c < 0 ||
               std::string_view("_-+=.,:/@%").find(c) != std::string_view::npos;
    };
    if (!path.empty() && std::all_of(path.begin(), path.end(), is_plain))
        return path;
    std::string quoted = "'";
    for (const char c : path)
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

} // namespace lamella
