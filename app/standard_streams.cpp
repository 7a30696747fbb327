#include "standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace lamella::app {

void reserve_standard_streams() noexcept {
    // O_PATH descriptors can be neither read nor written, and "/" exists on every system. Each call of open
    // returns the lowest free number.
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(number, F_GETFD) < 0)
            static_cast<void>(open("/", O_PATH | O_DIRECTORY));
}

bool output_is_closed() noexcept {
    const int flags = fcntl(STDOUT_FILENO, F_GETFL);
    return flags < 0 || (flags & O_PATH) != 0;
}

std::string input_name(const std::string& path) {
    return path == "-" ? "standard input" : path;
}

std::string output_name(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

} // namespace lamella::app
