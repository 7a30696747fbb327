#include "system/byte_source.hpp"

#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "system/growing_memory.hpp"
#include "system/spill_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

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

} // namespace

/// A regular file and its size when it was opened. The destructor closes it.
class OpenFile {
  public:
    explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
    ~OpenFile() { close(descriptor_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    /// Returns false if the process already has half of the files open that it may open, because the others
    /// are kept for other uses.
    [[nodiscard]] bool may_stay_open() const noexcept { return descriptor_ < sysconf(_SC_OPEN_MAX) / 2; }

    std::uint64_t size = 0;

  private:
    int descriptor_;
};

std::uint64_t ByteSource::size() const noexcept {
    return file ? file->size : bytes.size();
}

namespace {

/// Memory mapped by the system.
class Mapping {
  public:
    Mapping(void* data, std::size_t bytes) : data_(data), bytes_(bytes) {}
    ~Mapping() { munmap(data_, bytes_); }
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;

  private:
    void* data_;
    std::size_t bytes_;
};

/// Maps a temporary file. It has no name, so no other process can shorten it.
ByteSource map_spilled(std::string name, const SpillFile& file, std::size_t bytes) {
    void* const data = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
    if (data == MAP_FAILED)
        throw std::bad_alloc();
    const auto mapping = std::make_shared<Mapping>(data, bytes);
    madvise(data, bytes, MADV_SEQUENTIAL); // readers go from front to back
    return {std::move(name), {static_cast<const std::byte*>(data), bytes}, mapping, true};
}

[[noreturn]] void fail_cut_off(const ByteSource& source, std::uint64_t offset) {
    struct stat status {};
    std::uint64_t end = offset;
    if (fstat(source.file->descriptor(), &status) == 0)
        end = std::min(end, static_cast<std::uint64_t>(status.st_size));
    fail(source.name, "was cut off while it was read: it had " + std::to_string(source.size()) +
                          " bytes, and ends after " + std::to_string(end) + " now");
}

/// Reads until `to` is full or the file ends. Returns the number of bytes read.
std::size_t read_at(int descriptor, std::uint64_t offset, std::span<std::byte> to, const std::string& name) {
    std::size_t done = 0;
    while (done < to.size()) {
        const ssize_t got =
            pread(descriptor, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
        if (got == 0)
            break;
        if (got > 0)
            done += static_cast<std::size_t>(got);
        else if (errno != EINTR)
            fail_with_errno(name, errno);
    }
    return done;
}

/// Reads up to `most` bytes from the beginning of a regular file. Some system files have fewer bytes than
/// they report.
ByteSource read_beginning(int descriptor, std::string name, std::size_t most) {
    const auto memory = std::make_shared<Pages>(most);
    auto* const data = static_cast<std::byte*>(memory->data());
    const std::size_t bytes = read_at(descriptor, 0, {data, most}, name);
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
            return; // ready, or an error that the next read reports
    }
}

/// Waits for bytes and reads some of them. Returns 0 at the end.
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

/// Copies the bytes read before and all further ones to a spill file.
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
    return map_spilled(std::move(name), file, size);
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

ByteSource take(std::shared_ptr<OpenFile> file, std::string name, std::uint64_t most_in_memory,
                WindowTest* in_windows, const Execution& execution) {
    const int descriptor = file->descriptor();
    const int flags = fcntl(descriptor, F_GETFL);
    if (flags < 0 || (flags & O_PATH) != 0 || (flags & O_ACCMODE) == O_WRONLY)
        fail_with_errno(name, EBADF);
    struct stat status {};
    if (fstat(descriptor, &status) != 0)
        fail_with_errno(name, errno);
    if (S_ISDIR(status.st_mode))
        fail_with_errno(name, EISDIR);
    // A device may have no end. A terminal has one, when its user ends the input.
    if (S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && isatty(descriptor) == 0))
        fail(name, "is a device, expected a file or a pipe");
    // Some system files report a size of 0, and standard input may have been read in part. These are read to
    // their end.
    if (!S_ISREG(status.st_mode) || status.st_size <= 0 || lseek(descriptor, 0, SEEK_CUR) != 0)
        return read_to_end(descriptor, std::move(name), most_in_memory, execution);
    file->size = static_cast<std::uint64_t>(status.st_size);
    ByteSource source =
        read_beginning(descriptor, std::move(name), std::min<std::uint64_t>(file->size, window_beginning));
    if (file->size < window_beginning && file->size <= most_in_memory)
        return source;
    posix_fadvise(descriptor, 0, 0, POSIX_FADV_SEQUENTIAL); // doubles the read-ahead from a cold disk
    const std::size_t expected = std::min<std::uint64_t>(file->size, window_beginning);
    source.file = std::move(file);
    if (source.bytes.size() < expected)
        fail_cut_off(source, source.bytes.size());
    if (in_windows != nullptr && source.file->may_stay_open() && in_windows(source.bytes, source.size()))
        return source;
    return whole(source, execution, most_in_memory);
}

} // namespace

ByteSource open_bytes(const std::string& path, const Execution& execution, std::uint64_t most_in_memory,
                      WindowTest* in_windows) {
    const bool standard_input = path == "-";
    std::string name = standard_input ? "standard input" : path;
    // Non-blocking: waiting for the writer of a pipe must not delay cancellation.
    const int descriptor = standard_input ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                                          : open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0)
        fail_with_errno(name, errno);
    return take(std::make_shared<OpenFile>(descriptor), std::move(name), most_in_memory, in_windows,
                execution);
}

ByteSource whole(const ByteSource& source, const Execution& execution, std::uint64_t most_in_memory) {
    if (!source.file)
        return source;
    constexpr std::uint64_t window = std::uint64_t{1} << 20;
    Executor executor(execution);
    if (source.size() <= most_in_memory) {
        const auto memory = std::make_shared<PageArray<std::byte>>(source.size());
        executor.for_chunks(source.size(), window, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
            copy_out(source, begin, memory->span().subspan(begin, end - begin));
        });
        return {source.name, memory->span(), memory};
    }
    SpillFile file(source.size());
    std::vector<PageArray<std::byte>> windows(executor.workers());
    executor.for_chunks(source.size(), window, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
        if (windows[worker].size() == 0)
            windows[worker] = PageArray<std::byte>(window);
        const std::span<std::byte> bytes = windows[worker].span().first(end - begin);
        copy_out(source, begin, bytes);
        file.write(begin, bytes);
    });
    return map_spilled(source.name, file, source.size());
}

void copy_out(const ByteSource& source, std::uint64_t offset, std::span<std::byte> to) {
    assert(offset <= source.size() && to.size() <= source.size() - offset);
    if (!source.file) {
        if (!to.empty())
            std::memcpy(to.data(), source.bytes.data() + offset, to.size());
        return;
    }
    if (const std::size_t got = read_at(source.file->descriptor(), offset, to, source.name); got < to.size())
        fail_cut_off(source, offset + got);
}

void release(const ByteSource& source, std::span<const std::byte> stretch) noexcept {
    if (!source.on_disk)
        return;
    // Other readers may be using the first and the last page of the range. These pages are then read again.
    static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::byte* const base = source.bytes.data(); // at the beginning of a page
    const auto begin = static_cast<std::size_t>(stretch.data() - base);
    const std::size_t first = begin / page * page;
    const std::size_t last = begin + stretch.size();
    if (first < last)
        madvise(const_cast<std::byte*>(base) + first, last - first, MADV_DONTNEED);
}

Execution releasing(const ByteSource& source, const Execution& execution) {
    if (!source.on_disk)
        return execution;
    Execution result = execution;
    result.progress = [source, wished = execution.progress](const Progress& progress) {
        release(source, source.bytes.first(std::min<std::uint64_t>(progress.done, source.bytes.size())));
        if (wished)
            wished(progress);
    };
    return result;
}

ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name) {
    if (bytes.empty())
        fail(name, "is empty, expected a file with content");
    const auto memory = std::make_shared<Pages>(bytes.size());
    std::memcpy(memory->data(), bytes.data(), bytes.size());
    return {std::move(name), {static_cast<const std::byte*>(memory->data()), bytes.size()}, memory};
}

} // namespace lamella
