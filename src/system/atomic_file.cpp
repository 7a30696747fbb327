#include "system/atomic_file.hpp"

#include "lamella/system/whole_file.hpp"

#include "system/nameless_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace lamella {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18;

// Returns the first folder in `path` that is missing or is not a folder, which is the one that the user has
// to examine.
std::string first_bad_folder(const std::string& path) {
    fs::path folder = fs::path(path).parent_path();
    std::error_code ignored;
    while (!folder.parent_path().empty() && folder.parent_path() != folder &&
           !fs::is_directory(folder.parent_path(), ignored))
        folder = folder.parent_path();
    return folder.string();
}

bool working_folder_is_gone() {
    std::error_code error;
    static_cast<void>(fs::current_path(error));
    return error == std::errc::no_such_file_or_directory;
}

std::string folder_of(const std::string& path) {
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

// Returns whether a path, such as /dev/stdout, names a file that is already open. Such a file must not be
// replaced, because its owner would no longer have it.
bool names_open_file(const fs::path& path) {
    std::error_code error;
    const std::string text = fs::absolute(path, error).lexically_normal().string();
    return text.starts_with("/proc/") || text.starts_with("/dev/fd/") || text == "/dev/stdout" ||
           text == "/dev/stderr";
}

// Returns the end of a chain of symbolic links, even if no file exists there; empty if the chain leads to a
// file that is already open. Throws errno as an int.
std::string follow_links(const std::string& path) {
    fs::path current = path;
    constexpr int most_links = 40; // the limit of Linux
    for (int i = 0; i < most_links; ++i) {
        if (names_open_file(current))
            return {};
        struct stat status {};
        if (lstat(current.c_str(), &status) != 0 || !S_ISLNK(status.st_mode))
            return current.string();
        std::error_code error;
        const fs::path next = fs::read_symlink(current, error);
        if (error)
            throw error.value();
        current = current.parent_path() / next; // an absolute link replaces the folder
    }
    throw ELOOP;
}

} // namespace

std::string name_of_output(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

Error output_error(const std::string& path, int system_error) {
    const std::string what = path == "-" ? name_of_output(path) : "'" + path + "'";
    const auto text = [&](const std::string& reason) {
        return Error(ErrorKind::output, fmt::format("cannot write {}: {}", what, reason));
    };
    // The error for this differs between systems.
    if (path != "-" && fs::path(path).is_relative() && working_folder_is_gone())
        return text("the working folder has been removed; choose another place");
    switch (system_error) {
    case ENOENT:
        return text(fmt::format("the folder '{}' does not exist; create it first", first_bad_folder(path)));
    case ENOTDIR:
        return text(
            fmt::format("'{}' is a file, not a folder; choose another place", first_bad_folder(path)));
    case EISDIR:
        return text("it is a folder; give the name of a file");
    case EACCES:
    case EPERM:
        return text(fmt::format("no permission in the folder '{}'; choose another place or change the "
                                "permissions",
                                folder_of(path)));
    case EROFS:
        return text("the file system is read-only; choose another place");
    case ENOSPC:
        return text("the disk is full; free some space or choose another place");
    case EDQUOT:
        return text("the disk quota is used up; free some space or choose another place");
    case EFBIG:
        return text(
            "the file has become larger than the file system or the limit of this process allows (see "
            "ulimit -f)");
    case ENAMETOOLONG:
        return text("the name is too long; choose a shorter one");
    case ELOOP:
        return text("its symbolic links run in a circle");
    case EPIPE:
        return text("the reader of the pipe has gone");
    case EBADF:
        return text("it is closed or not open for writing");
    case EMFILE:
    case ENFILE:
        return text("too many files are open (see ulimit -n)");
    case EIO:
        return text("the device reports an error; check the disk");
    default:
        return text(std::generic_category().message(system_error));
    }
}

unsigned kept_permissions(unsigned mode, bool same_group) noexcept {
    return mode & (same_group ? 07777U : 07777U & ~(S_IRWXG | S_ISGID));
}

AtomicFile::AtomicFile(std::string path, Overwriting overwriting) : path_(std::move(path)) {
    buffer_.reset(new char[buffer_size]); // unused pages take no memory
    if (path_ == "-") {
        descriptor_ = STDOUT_FILENO;
        owns_descriptor_ = false;
        if (overwriting == Overwriting::yes)
            spool();
        return;
    }
    if (path_.empty())
        throw Error(ErrorKind::output, "cannot write a file without a name");
    struct stat status {};
    const bool exists = stat(path_.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        fail(EISDIR);
    if (path_.back() == '/')
        fail(exists ? EISDIR : ENOENT);
    try {
        target_ = follow_links(path_);
    } catch (int system_error) {
        fail(system_error);
    }
    if (!target_.empty() && (!exists || S_ISREG(status.st_mode))) {
        open_unfinished();
        return;
    }
    open_in_place();
    if (overwriting == Overwriting::yes)
        spool();
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::open_in_place() {
    do
        descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, 0666);
    while (descriptor_ < 0 && errno == EINTR); // opening a FIFO waits for its reader
    if (descriptor_ < 0)
        fail(errno);
}

void AtomicFile::spool() {
    spool_ = create_scratch(scratch_folder());
    if (spool_ < 0)
        fail_spool(errno);
}

void AtomicFile::fail_spool(int system_error) {
    discard();
    throw Error(ErrorKind::output,
                fmt::format("cannot write a temporary file in the folder '{}', where this output waits for "
                            "its end: {}; set the environment variable TMPDIR to a folder that can be "
                            "written and has room",
                            scratch_folder(), std::generic_category().message(system_error)));
}

void AtomicFile::open_unfinished() {
    struct stat status {};
    const bool replaces = stat(target_.c_str(), &status) == 0;
    if (!replaces && errno == ENAMETOOLONG) // the temporary name may be shorter
        fail(errno);
    // A rename would replace a write-protected file, against the intention of its owner.
    if (replaces && access(target_.c_str(), W_OK) != 0) {
        const int error = errno;
        if (error == EACCES)
            throw Error(
                ErrorKind::output,
                fmt::format("cannot write '{}': the file there is write-protected; remove it or choose "
                            "another name",
                            path_));
        fail(error);
    }
    constexpr mode_t everybody = 0666; // the umask applies
    descriptor_ = create_nameless(folder_of(target_), everybody);
    if (descriptor_ >= 0)
        nameless_ = true;
    else if (errno == EOPNOTSUPP)
        open_named(everybody);
    else
        fail(errno);
    // A new file gets permissions from the umask. A replacement gets those of the old file, if this process
    // may set them.
    if (replaces) {
        const bool same_group = fchown(descriptor_, static_cast<uid_t>(-1), status.st_gid) == 0;
        static_cast<void>(fchmod(descriptor_, kept_permissions(status.st_mode, same_group)));
    }
}

void AtomicFile::open_named(mode_t permissions) {
    const UnfinishedName::Creation creation;
    temporary_ = take_free_name(target_, this_process(), [&](const char* name) {
        descriptor_ = ::open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, permissions);
        return descriptor_ >= 0;
    });
    if (temporary_.empty())
        fail(errno);
    announce();
}

void AtomicFile::give_temporary_name() {
    const UnfinishedName::Creation creation;
    temporary_ = take_free_name(target_, this_process(),
                                [this](const char* name) { return name_file(descriptor_, name); });
    if (temporary_.empty())
        fail(errno);
    nameless_ = false;
    announce();
}

void AtomicFile::announce() {
    if (unfinished_.announce(temporary_))
        return;
    discard();
    throw Error(ErrorKind::cancelled, "cancelled");
}

const std::string& AtomicFile::share() {
    if (nameless_)
        give_temporary_name();
    return temporary_;
}

void AtomicFile::append(std::string_view bytes) {
    if (descriptor_ < 0)
        throw Error(ErrorKind::internal, fmt::format("'{}' was written to after its end", path_));
    if (bytes.empty())
        return; // an empty view may be a null pointer
    bytes_.fetch_add(bytes.size(), std::memory_order_relaxed);
    const std::size_t free = buffer_size - buffered_;
    if (bytes.size() > free && buffered_ > 0) {
        std::memcpy(buffer_.get() + buffered_, bytes.data(), free);
        buffered_ = buffer_size;
        flush();
        bytes.remove_prefix(free);
    }
    // Whole buffers at a time, so that each write fills the pages that it touches.
    if (const std::size_t whole = bytes.size() - bytes.size() % buffer_size; whole > 0) {
        write_out(bytes.substr(0, whole));
        bytes.remove_prefix(whole);
    }
    std::memcpy(buffer_.get() + buffered_, bytes.data(), bytes.size());
    buffered_ += bytes.size();
    assert(buffered_ < buffer_size + 1);
}

void AtomicFile::flush() {
    write_out({buffer_.get(), std::exchange(buffered_, 0)});
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
    flush();
    while (!bytes.empty()) {
        const int descriptor = spool_ >= 0 ? spool_ : descriptor_;
        const ssize_t written = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
            offset += static_cast<std::uint64_t>(written);
        } else if (errno != EINTR) {
            fail(errno);
        }
    }
}

// Copies the spool to the output; later writes go to the output directly.
void AtomicFile::copy_spool() {
    const int from = std::exchange(spool_, -1);
    off_t offset = 0;
    ssize_t got = 0;
    do {
        got = ::pread(from, buffer_.get(), buffer_size, offset);
        if (got > 0) {
            try {
                write_out({buffer_.get(), static_cast<std::size_t>(got)});
            } catch (...) {
                ::close(from);
                throw;
            }
            offset += got;
        }
    } while (got > 0 || (got < 0 && errno == EINTR));
    const int system_error = errno;
    ::close(from);
    if (got < 0)
        fail(system_error);
}

void AtomicFile::write_out(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(spool_ >= 0 ? spool_ : descriptor_, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            pollfd ready{.fd = descriptor_, .events = POLLOUT, .revents = 0};
            ::poll(&ready, 1, -1); // the next write reports the result
        } else if (errno != EINTR) {
            fail(errno);
        }
    }
}

void AtomicFile::commit() {
    if (descriptor_ < 0)
        throw Error(ErrorKind::internal, fmt::format("'{}' was ended twice", path_));
    flush();
    if (spool_ >= 0)
        copy_spool();
    // Only a rename can take a name that is in use.
    if (nameless_)
        give_temporary_name();
    const int descriptor = std::exchange(descriptor_, -1);
    // On Linux, an interrupted close has closed the file.
    if (owns_descriptor_ && ::close(descriptor) != 0 && errno != EINTR)
        fail(errno);
    if (!temporary_.empty()) {
        if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
            fail(errno);
        temporary_.clear();
        unfinished_.withdraw();
    }
}

void AtomicFile::discard() noexcept {
    const int descriptor = std::exchange(descriptor_, -1);
    if (descriptor >= 0 && owns_descriptor_)
        ::close(descriptor);
    if (const int spooled = std::exchange(spool_, -1); spooled >= 0)
        ::close(spooled);
    if (!temporary_.empty())
        ::unlink(temporary_.c_str());
    temporary_.clear();
    nameless_ = false;
    unfinished_.withdraw();
}

void AtomicFile::fail(int system_error) {
    if (spool_ >= 0 && (system_error == ENOSPC || system_error == EDQUOT))
        fail_spool(system_error);
    discard();
    throw output_error(target_.empty() ? path_ : target_, system_error);
}

void write_whole_file(const std::string& path, std::string_view bytes) {
    AtomicFile file(path);
    file.append(bytes);
    file.commit();
}

void check_writable(const std::string& path) {
    struct stat status {};
    const bool exists = path != "-" && stat(path.c_str(), &status) == 0;
    if (path == "-" || names_open_file(path) ||
        (exists && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)))
        return;
    const AtomicFile file(path);
}

} // namespace lamella
