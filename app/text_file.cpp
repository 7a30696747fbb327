#include "text_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/system/whole_file.hpp"

#include "standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <span>
#include <system_error>

namespace lamella::app {
namespace {

std::string reason(int error) {
    return error == EBADF ? "it is closed" : std::generic_category().message(error);
}

[[noreturn]] void fail_to_print(int error) {
    throw Error(ErrorKind::output, fmt::format("standard output: cannot be written: {}", reason(error)));
}

struct Descriptor {
    explicit Descriptor(int file) : number(file) {}
    ~Descriptor() {
        if (number >= 0)
            close(number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number;
};

/// Reads some bytes, waiting for them if necessary; returns 0 at the end.
template <class Refuse>
std::size_t read_some(int descriptor, std::span<char> room, const Refuse& refuse) {
    for (;;) {
        const ssize_t got = ::read(descriptor, room.data(), room.size());
        if (got >= 0)
            return static_cast<std::size_t>(got);
        if (errno != EINTR && errno != EAGAIN)
            refuse(errno);
        pollfd waiting{descriptor, POLLIN, 0}; // an inherited descriptor may be non-blocking
        poll(&waiting, 1, -1);
    }
}

} // namespace

std::string read_text_file(const std::string& path) {
    const std::string name = input_name(path);
    const auto refuse = [&](int error) {
        if (error == ENOENT)
            throw Error(ErrorKind::input, fmt::format("{}: there is no such file", name));
        throw Error(ErrorKind::input, fmt::format("{}: cannot be read: {}", name, reason(error)));
    };
    // Standard input is read by its descriptor, because some files, such as a socket, cannot be opened by
    // name.
    const Descriptor file(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number < 0)
        refuse(errno);
    std::string text;
    std::array<char, 1 << 16> block;
    while (const std::size_t n = read_some(file.number, block, refuse))
        text.append(block.data(), n);
    if (constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; text.starts_with(byte_order_mark))
        text.erase(0, byte_order_mark.size());
    return text;
}

void write_text_file(const std::string& path, std::string_view text) {
    if (path == "-")
        print(text); // after earlier output
    else
        write_whole_file(path, text);
}

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        fail_to_print(errno);
}

void finish_printing() {
    if (std::fflush(stdout) != 0)
        fail_to_print(errno);
}

} // namespace lamella::app
