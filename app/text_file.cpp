#include "text_file.hpp"

#include "lamella/core/error.hpp"

#include "standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>

namespace lamella::app {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error) {
    return error == EBADF ? "it is closed" : std::generic_category().message(error);
}

[[noreturn]] void fail(const std::string& path, int error) {
    throw Error(ErrorKind::output, fmt::format("{}: cannot be written: {}", path, reason(error)));
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

/// Some bytes, once there are any; 0 at the end.
template <class Refuse>
std::size_t read_some(int descriptor, std::span<char> room, const Refuse& refuse) {
    for (;;) {
        const ssize_t got = ::read(descriptor, room.data(), room.size());
        if (got >= 0)
            return static_cast<std::size_t>(got);
        if (errno != EINTR && errno != EAGAIN)
            refuse(errno);
        pollfd waiting{descriptor, POLLIN, 0}; // whoever lent it may not want it to block
        poll(&waiting, 1, -1);
    }
}

void write_in_place(const std::string& path, const std::string& shown, std::string_view text) {
    File file(std::fopen(path.c_str(), "wb"));
    if (file == nullptr)
        fail(shown, errno);
    // The last bytes meet the disk only when the file is closed.
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
        std::fclose(file.release()) != 0)
        fail(shown, errno);
}

} // namespace

std::string read_text_file(const std::string& path) {
    const std::string name = input_name(path);
    const auto refuse = [&](int error) {
        throw Error(ErrorKind::input, fmt::format("{}: cannot be read: {}", name, reason(error)));
    };
    // By its descriptor: what is at the other end, such as a socket, need not be there to be opened again.
    const Descriptor file(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number < 0)
        refuse(errno);
    std::string text;
    std::array<char, 1 << 16> block;
    while (const std::size_t n = read_some(file.number, block, refuse))
        text.append(block.data(), n);
    return text;
}

void write_text_file(const std::string& path, std::string_view text) {
    if (path == "-") {
        print(text);
        return;
    }
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        write_in_place(path, path, text);
        return;
    }
    const std::string temporary = fmt::format("{}.{}.part", path, getpid());
    try {
        write_in_place(temporary, path, text);
        if (std::rename(temporary.c_str(), path.c_str()) != 0)
            fail(path, errno);
    } catch (...) {
        static_cast<void>(std::remove(temporary.c_str()));
        throw;
    }
}

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        fail("standard output", errno);
}

void finish_printing() {
    if (std::fflush(stdout) != 0)
        fail("standard output", errno);
}

} // namespace lamella::app
