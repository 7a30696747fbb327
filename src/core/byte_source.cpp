#include "core/byte_source.hpp"

#include "lamella/core/error.hpp"

#include "core/growing_memory.hpp"
#include "core/pages.hpp"
#include "core/spill_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
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
        fail(name, "is a folder, expected a file");
    case EBADF:
        fail(name, "is closed, or not open for reading");
    default:
        fail(name, "cannot be read: " + std::generic_category().message(code));
    }
}

[[noreturn]] void fail_cut_off(const ByteSource& source, std::uint64_t end) {
    fail(source.name, "was cut off while it was read: it had " + std::to_string(source.bytes.size()) +
                          " bytes, and ends after " + std::to_string(end) + " now");
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

/// Memory that the system mapped, and the file that it comes from, if that is kept open.
class Mapping {
  public:
    Mapping(void* data, std::size_t bytes, int descriptor)
        : data_(data), bytes_(bytes), descriptor_(descriptor) {}
    ~Mapping() {
        munmap(data_, bytes_);
        if (descriptor_ >= 0)
            close(descriptor_);
    }
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;

    [[nodiscard]] std::byte* data() const noexcept { return static_cast<std::byte*>(data_); }
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

  private:
    void* data_;
    std::size_t bytes_;
    int descriptor_;
};

/// Another descriptor of the same file; -1 where so many are in use that others will need the rest.
int keep_open(int descriptor) {
    const int kept = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
    if (kept < 0 || kept < sysconf(_SC_OPEN_MAX) / 2)
        return kept;
    close(kept);
    return -1;
}

std::shared_ptr<Mapping> map_file(int descriptor, std::size_t bytes) {
    void* data = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (data == MAP_FAILED)
        return nullptr;
    // Readers go through a file from front to back; on a cold disk this doubles the window of read-ahead.
    madvise(data, bytes, MADV_SEQUENTIAL);
    posix_fadvise(descriptor, 0, 0, POSIX_FADV_SEQUENTIAL);
    return std::make_shared<Mapping>(data, bytes, keep_open(descriptor));
}

ByteSource mapped_bytes(std::string name, const std::shared_ptr<Mapping>& mapping, std::size_t bytes) {
    return {std::move(name), {mapping->data(), bytes}, mapping, true, mapping->descriptor()};
}

/// A small regular file, to its end as it is now: some files of the system have fewer bytes than they say.
ByteSource read_whole(int descriptor, std::string name, std::size_t most) {
    const auto memory = std::make_shared<Pages>(most);
    auto* const data = static_cast<std::byte*>(memory->data());
    std::size_t bytes = 0;
    while (bytes < most) {
        const ssize_t got = pread(descriptor, data + bytes, most - bytes, static_cast<off_t>(bytes));
        if (got == 0)
            break;
        if (got > 0)
            bytes += static_cast<std::size_t>(got);
        else if (errno != EINTR)
            fail_with_errno(name, errno);
    }
    if (bytes == 0)
        fail(name, "is empty, expected a file with content");
    return {std::move(name), {data, bytes}, memory};
}

/// Waits until reading does not block.
void wait_for_bytes(int descriptor, const Execution& execution) {
    constexpr int patience_ms = 100;
    for (;;) {
        if (execution.cancelled())
            throw Error(ErrorKind::cancelled, "cancelled");
        pollfd waiting{descriptor, POLLIN, 0};
        if (poll(&waiting, 1, patience_ms) != 0)
            return; // ready, or an error that reading will name
    }
}

/// Reads some bytes, once there are any. 0 at the end.
std::size_t read_some(int descriptor, std::span<std::byte> room, const std::string& name,
                      const Execution& execution) {
    for (;;) {
        wait_for_bytes(descriptor, execution);
        const ssize_t got = read(descriptor, room.data(), room.size());
        if (got >= 0)
            return static_cast<std::size_t>(got);
        if (errno != EINTR && errno != EAGAIN)
            fail_with_errno(name, errno);
    }
}

/// What has come already, and all that is still to come, by way of a spill file.
ByteSource spool(int descriptor, std::string name, std::span<const std::byte> begin,
                 const Execution& execution) {
    SpillFile file;
    file.write(0, begin);
    std::uint64_t size = begin.size();
    constexpr std::size_t at_once = std::size_t{1} << 20;
    const Pages memory(at_once);
    const std::span<std::byte> room(static_cast<std::byte*>(memory.data()), at_once);
    while (const std::size_t got = read_some(descriptor, room, name, execution)) {
        file.write(size, room.first(got));
        size += got;
    }
    const auto mapping = map_file(file.descriptor(), size);
    if (!mapping)
        fail_with_errno(name, errno);
    return mapped_bytes(std::move(name), mapping, size);
}

ByteSource read_to_end(int descriptor, std::string name, std::uint64_t most_in_memory,
                       const Execution& execution) {
    auto memory = std::make_shared<GrowingMemory>();
    while (const std::size_t got = read_some(descriptor, memory->room(), name, execution)) {
        memory->use(got);
        if (memory->size() > most_in_memory)
            return spool(descriptor, std::move(name), memory->bytes(), execution);
    }
    if (memory->size() == 0)
        fail(name, "is empty, expected a file with content");
    memory->trim();
    return {std::move(name), memory->bytes(), memory};
}

ByteSource take(const Descriptor& descriptor, std::string name, std::uint64_t most_in_memory,
                const Execution& execution) {
    const int flags = fcntl(descriptor.number(), F_GETFL);
    if (flags < 0 || (flags & O_PATH) != 0 || (flags & O_ACCMODE) == O_WRONLY)
        fail_with_errno(name, EBADF);
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
        // To map and unmap a small file costs more than to read it: see the batch of bench/small_parts.
        constexpr std::size_t worth_mapping = std::size_t{1} << 16;
        if (size < worth_mapping)
            return read_whole(descriptor.number(), std::move(name), size);
        if (const auto mapping = map_file(descriptor.number(), size))
            return mapped_bytes(std::move(name), mapping, size);
    }
    return read_to_end(descriptor.number(), std::move(name), most_in_memory, execution);
}

} // namespace

ByteSource open_bytes(const std::string& path, const Execution& execution, std::uint64_t most_in_memory) {
    if (path == "-")
        return take(Descriptor(STDIN_FILENO, false), "standard input", most_in_memory, execution);
    // Not blocking: a pipe that nobody writes to yet must not hold up a request to stop.
    const int number = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (number < 0)
        fail_with_errno(path, errno);
    return take(Descriptor(number, true), path, most_in_memory, execution);
}

void copy_out(const ByteSource& source, std::uint64_t place, std::span<std::byte> to) {
    assert(place <= source.bytes.size() && to.size() <= source.bytes.size() - place);
    if (source.descriptor < 0) {
        if (!to.empty())
            std::memcpy(to.data(), source.bytes.data() + place, to.size());
        return;
    }
    while (!to.empty()) {
        const ssize_t got = pread(source.descriptor, to.data(), to.size(), static_cast<off_t>(place));
        if (got < 0 && errno != EINTR)
            fail_with_errno(source.name, errno);
        if (got == 0)
            fail_cut_off(source, place);
        if (got > 0) {
            place += static_cast<std::uint64_t>(got);
            to = to.subspan(static_cast<std::size_t>(got));
        }
    }
}

void check_length(const ByteSource& source) {
    struct stat status {};
    if (source.mapped && source.descriptor >= 0 && fstat(source.descriptor, &status) == 0 &&
        static_cast<std::uint64_t>(status.st_size) < source.bytes.size())
        fail_cut_off(source, static_cast<std::uint64_t>(status.st_size));
}

void release(const ByteSource& source, std::span<const std::byte> stretch) noexcept {
    if (!source.mapped)
        return;
    // The first and the last page may be in use by others: then those bring them back.
    static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::byte* const base = source.bytes.data(); // at the beginning of a page
    const auto begin = static_cast<std::size_t>(stretch.data() - base);
    const std::size_t first = begin / page * page;
    const std::size_t last = begin + stretch.size();
    if (first < last)
        madvise(const_cast<std::byte*>(base) + first, last - first, MADV_DONTNEED);
}

ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name) {
    if (bytes.empty())
        fail(name, "is empty, expected a file with content");
    const auto memory = std::make_shared<Pages>(bytes.size());
    std::memcpy(memory->data(), bytes.data(), bytes.size());
    return {std::move(name), {static_cast<const std::byte*>(memory->data()), bytes.size()}, memory};
}

} // namespace lamella
