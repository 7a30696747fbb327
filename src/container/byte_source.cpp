#include "container/byte_source.hpp"

#include "lamella/core/error.hpp"

#include "container/growing_memory.hpp"
#include "core/pages.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

namespace lamella {

namespace {

[[noreturn]] void fail(const std::string& name, const std::string& text) {
    throw Error(ErrorKind::input, name + ": " + text);
}

[[noreturn]] void fail_with_errno(const std::string& name, int code) {
    switch (code) {
    case ENOENT:
    case ENOTDIR:
        fail(name, "there is no such file");
    case EACCES:
    case EPERM:
        fail(name, "no permission to read this file");
    case EISDIR:
        fail(name, "is a directory, expected a file");
    default:
        fail(name, "cannot be read: " + std::generic_category().message(code));
    }
}

/// A file descriptor that is closed at the end, but for one that was lent (standard input).
class Descriptor {
  public:
    Descriptor(int number, bool owned) : number_(number), owned_(owned) {}
    ~Descriptor() {
        if (owned_)
            close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int number() const noexcept { return number_; }

  private:
    int number_;
    bool owned_;
};

/// Memory that the system mapped.
class Mapping {
  public:
    Mapping(void* data, std::size_t bytes) : data_(data), bytes_(bytes) {}
    ~Mapping() { munmap(data_, bytes_); }
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;

    [[nodiscard]] std::byte* data() const noexcept { return static_cast<std::byte*>(data_); }

  private:
    void* data_;
    std::size_t bytes_;
};

std::shared_ptr<Mapping> map_file(int descriptor, std::size_t bytes) {
    void* data = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (data == MAP_FAILED)
        return nullptr;
    // Readers go through a file from front to back; on a cold disk this doubles the window of read-ahead.
    madvise(data, bytes, MADV_SEQUENTIAL);
    return std::make_shared<Mapping>(data, bytes);
}

/// Waits until reading does not block.
void wait_for_bytes(int descriptor, const std::stop_token& cancel) {
    constexpr int patience_ms = 100;
    for (;;) {
        if (cancel.stop_requested())
            throw Error(ErrorKind::cancelled, "cancelled");
        pollfd waiting{descriptor, POLLIN, 0};
        if (poll(&waiting, 1, patience_ms) != 0)
            return; // ready, or an error that reading will name
    }
}

ByteSource read_to_end(int descriptor, std::string name, const std::stop_token& cancel) {
    const auto memory = std::make_shared<GrowingMemory>();
    for (;;) {
        const std::span<std::byte> room = memory->room();
        wait_for_bytes(descriptor, cancel);
        const ssize_t got = read(descriptor, room.data(), room.size());
        if (got > 0)
            memory->use(static_cast<std::size_t>(got));
        else if (got == 0)
            break;
        else if (errno != EINTR && errno != EAGAIN)
            fail_with_errno(name, errno);
    }
    if (memory->size() == 0)
        fail(name, "is empty, expected a file with content");
    memory->trim();
    return {std::move(name), memory->bytes(), memory};
}

ByteSource take(const Descriptor& descriptor, std::string name, const std::stop_token& cancel) {
    struct stat status {};
    if (fstat(descriptor.number(), &status) != 0)
        fail_with_errno(name, errno);
    if (S_ISDIR(status.st_mode))
        fail_with_errno(name, EISDIR);
    // Devices may have no end; a terminal has one when its user says so.
    if (S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && isatty(descriptor.number()) == 0))
        fail(name, "is a device, expected a file or a pipe");
    // Some files of the system claim to have no bytes, and standard input may be half read: those are read.
    if (S_ISREG(status.st_mode) && status.st_size > 0 && lseek(descriptor.number(), 0, SEEK_CUR) == 0) {
        const auto size = static_cast<std::size_t>(status.st_size);
        if (const auto mapping = map_file(descriptor.number(), size))
            return {std::move(name), {mapping->data(), size}, mapping};
    }
    return read_to_end(descriptor.number(), std::move(name), cancel);
}

} // namespace

ByteSource open_bytes(const std::string& path, const std::stop_token& cancel) {
    if (path == "-")
        return take(Descriptor(STDIN_FILENO, false), "standard input", cancel);
    // Not blocking: a pipe that nobody writes to yet must not hold up a request to stop.
    const int number = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (number < 0)
        fail_with_errno(path, errno);
    return take(Descriptor(number, true), path, cancel);
}

ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name) {
    if (bytes.empty())
        fail(name, "is empty, expected a file with content");
    const auto memory = std::make_shared<Pages>(bytes.size());
    std::memcpy(memory->data(), bytes.data(), bytes.size());
    return {std::move(name), {static_cast<const std::byte*>(memory->data()), bytes.size()}, memory};
}

} // namespace lamella
