#include "system/native_file.hpp"

#include "system/posix/kernel.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>

namespace lamella {

namespace {

int descriptor_of(const NativeFile& file) noexcept {
    return static_cast<int>(file.handle());
}

} // namespace

const int quota_error = EDQUOT;

bool NativeFile::close() noexcept {
    // On Linux, an interrupted close has closed the file.
    return !is_open() || ::close(static_cast<int>(release())) == 0 || errno == EINTR;
}

NativeFile open_input(const std::string& path) {
    // Non-blocking: waiting for the writer of a pipe must not delay cancellation.
    return NativeFile(path == "-" ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                                  : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
}

std::optional<InputStatus> status_of_input(const NativeFile& file) {
    const int descriptor = descriptor_of(file);
    const int flags = ::fcntl(descriptor, F_GETFL);
    if (flags < 0 || is_path_only(descriptor) || (flags & O_ACCMODE) == O_WRONLY)
        return InputStatus{InputKind::unreadable};
    struct stat status {};
    if (::fstat(descriptor, &status) != 0)
        return std::nullopt;
    if (S_ISDIR(status.st_mode))
        return InputStatus{InputKind::folder};
    // A device may have no end. A terminal has one, when its user ends the input.
    if (S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && ::isatty(descriptor) == 0))
        return InputStatus{InputKind::device};
    // Some system files report a size of 0, and standard input may have been read in part. These are read to
    // their end.
    if (!S_ISREG(status.st_mode) || status.st_size <= 0 || ::lseek(descriptor, 0, SEEK_CUR) != 0)
        return InputStatus{InputKind::stream};
    return InputStatus{InputKind::file, static_cast<std::uint64_t>(status.st_size)};
}

std::optional<std::uint64_t> size_of(const NativeFile& file) {
    struct stat status {};
    if (::fstat(descriptor_of(file), &status) != 0)
        return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
}

bool may_stay_open(const NativeFile& file) noexcept {
    return descriptor_of(file) < ::sysconf(_SC_OPEN_MAX) / 2;
}

void read_ahead(const NativeFile& file) noexcept {
    prefer_read_ahead(descriptor_of(file));
}

std::ptrdiff_t read_at(const NativeFile& file, std::uint64_t offset, std::span<std::byte> to) {
    std::size_t done = 0;
    while (done < to.size()) {
        const ssize_t got = ::pread(descriptor_of(file), to.data() + done, to.size() - done,
                                    static_cast<off_t>(offset + done));
        if (got == 0)
            break;
        if (got > 0)
            done += static_cast<std::size_t>(got);
        else if (errno != EINTR)
            return -1;
    }
    return static_cast<std::ptrdiff_t>(done);
}

bool wait_for_bytes(const NativeFile& file, int milliseconds) {
    pollfd waiting{descriptor_of(file), POLLIN, 0};
    return ::poll(&waiting, 1, milliseconds) != 0; // ready, or an error that the next read reports
}

std::ptrdiff_t read_some(const NativeFile& file, std::span<std::byte> to) {
    return ::read(descriptor_of(file), to.data(), to.size());
}

NativeFile standard_output() noexcept {
    return NativeFile(STDOUT_FILENO);
}

NativeFile open_in_place(const std::string& path) {
    int descriptor = -1;
    do
        descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, 0666);
    while (descriptor < 0 && errno == EINTR); // opening a FIFO waits for its reader
    return NativeFile(descriptor);
}

NativeFile open_existing(const std::string& path) {
    return NativeFile(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
}

bool write_all(const NativeFile& file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_of(file), bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            pollfd ready{.fd = descriptor_of(file), .events = POLLOUT, .revents = 0};
            ::poll(&ready, 1, -1); // the next write reports the result
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

bool write_all_at(const NativeFile& file, std::uint64_t offset, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::pwrite(descriptor_of(file), bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
            offset += static_cast<std::uint64_t>(written);
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

bool synchronise(const NativeFile& file) {
    return ::fsync(descriptor_of(file)) == 0 || errno == EINVAL; // a pipe, for example
}

bool reserve_space(const NativeFile& file, std::uint64_t bytes) {
    int failed = 0;
    do
        failed = reserve_blocks(descriptor_of(file), bytes);
    while (failed == EINTR);
    errno = failed;
    return failed != ENOSPC && failed != EDQUOT && failed != EFBIG;
}

void free_space(const NativeFile& file, std::uint64_t offset, std::uint64_t bytes) noexcept {
    const int before = errno;
    punch_hole(descriptor_of(file), offset, bytes);
    errno = before;
}

std::optional<std::uint64_t> free_bytes(const std::string& folder) {
    struct statvfs status {};
    if (::statvfs(folder.c_str(), &status) != 0 ||
        status.f_blocks == 0) // some file systems do not count blocks
        return std::nullopt;
    return std::uint64_t{status.f_bavail} * status.f_frsize;
}

} // namespace lamella
