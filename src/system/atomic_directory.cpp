#include "system/atomic_directory.hpp"

#include "system/atomic_file.hpp"
#include "system/nameless_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>

namespace lamella {

namespace fs = std::filesystem;

namespace {

/// Removes a folder even if it is not writable.
void remove_folder(const fs::path& folder) {
    static_cast<void>(::chmod(folder.c_str(), S_IRWXU));
    std::error_code ignored;
    fs::remove_all(folder, ignored);
}

/// Returns whether the folder is a mount point, which cannot be replaced; bind mounts count.
bool is_mount_point(const fs::path& folder) {
    struct statx status {};
    return ::statx(AT_FDCWD, folder.c_str(), 0, STATX_TYPE, &status) == 0 &&
           (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

/// Identifies the owner of hidden folders: all processes of this machine until it is rebooted. A lock shows
/// whether the process of a folder is still running. Other machines may share the disk but not the locks;
/// their folders have other names. If the system has no boot id, the owner is the process.
std::string this_machine() {
    std::ifstream file("/proc/sys/kernel/random/boot_id");
    std::string id;
    constexpr std::size_t enough = 8;
    return std::getline(file, id) && id.size() >= enough ? id.substr(0, enough) : this_process();
}

/// Returns false if the name has been removed or replaced in the meantime.
bool is_still(int descriptor, const char* name) {
    struct stat opened {};
    struct stat named {};
    return ::fstat(descriptor, &opened) == 0 && ::lstat(name, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

int open_folder(const char* name) {
    return ::open(name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/// Removes the hidden folder unless its process is still running. (A lock ends with its process in any case.)
/// Returns whether the name is free afterwards.
bool remove_abandoned(const char* name) {
    const int folder = open_folder(name);
    if (folder < 0)
        return false;
    const bool abandoned = ::flock(folder, LOCK_EX | LOCK_NB) == 0 && is_still(folder, name);
    if (abandoned)
        remove_folder(name);
    ::close(folder);
    struct stat status {};
    return abandoned && ::lstat(name, &status) != 0;
}

} // namespace

AtomicDirectory::AtomicDirectory(std::string path, std::function<bool(const fs::path&)> may_remove)
    : path_(std::move(path)), may_remove_(std::move(may_remove)) {
    std::error_code error;
    if (!path_.empty())                               // standard libraries differ for an empty path
        target_ = fs::weakly_canonical(path_, error); // follows symbolic links, which are kept
    if (error)
        target_ = path_;
    if (!target_.has_filename()) // "out/"
        target_ = target_.parent_path();
    if (target_.empty())
        throw Error(ErrorKind::output, "cannot write a folder without a name");
    check_replaceable();
    const UnfinishedName::Creation creation;
    working_ =
        take_free_name(target_, this_machine(), [this](const char* name) { return make_working(name); });
    if (working_.empty())
        throw output_error(target_.string(), errno);
    // A new folder gets permissions from the umask. A replacement gets those of the old folder, but this
    // process may write into it until commit.
    if (struct stat replaced{}; ::stat(target_.c_str(), &replaced) == 0) {
        const bool same_group = ::chown(working_.c_str(), static_cast<uid_t>(-1), replaced.st_gid) == 0;
        permissions_ = kept_permissions(replaced.st_mode, same_group);
        static_cast<void>(::chmod(working_.c_str(), *permissions_ | S_IRWXU));
    }
    if (!unfinished_.announce(working_.string())) {
        ::rmdir(working_.c_str());
        ::close(lock_);
        throw Error(ErrorKind::cancelled, "cancelled");
    }
}

AtomicDirectory::~AtomicDirectory() {
    if (!working_.empty())
        remove_folder(working_);
    if (lock_ >= 0)
        ::close(lock_);
}

bool AtomicDirectory::make_working(const char* name) {
    constexpr mode_t everybody = 0777; // the umask applies
    if (::mkdir(name, everybody) != 0) {
        if (errno == EEXIST)
            errno = remove_abandoned(name) ? EINTR : EEXIST; // try again, or try the next name
        return false;
    }
    lock_ = open_folder(name);
    if (lock_ < 0 && errno != ENOENT) { // without a lock, other processes would consider the folder abandoned
        const int system_error = errno;
        ::rmdir(name);
        errno = system_error;
        return false;
    }
    // If the file system has no locks, no process removes the folder.
    const bool locked = lock_ >= 0 && (::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK);
    if (locked && is_still(lock_, name))
        return true;
    // Another process considered the folder abandoned before it was locked, and removed it.
    if (lock_ >= 0)
        ::close(std::exchange(lock_, -1));
    errno = EEXIST;
    return false;
}

void AtomicDirectory::check_replaceable() const {
    std::error_code error;
    const fs::file_status status = fs::status(target_, error);
    if (status.type() == fs::file_type::not_found)
        return;
    if (status.type() == fs::file_type::none)
        throw output_error(path_, error.value());
    if (!fs::is_directory(status))
        throw Error(ErrorKind::output,
                    fmt::format("cannot write '{}': it is a file, and the layers go into a folder; choose "
                                "another name",
                                path_));
    if (is_mount_point(target_))
        throw Error(ErrorKind::output,
                    fmt::format("cannot write '{}': it is a mount point, which nothing can replace; choose a "
                                "folder in it, such as '{}'",
                                path_, (target_ / "layers").string()));
    // Another process may have replaced the folder and may be removing the old one. So entries that no longer
    // exist are not foreign, and each name is tested twice, because one test may see both folders.
    const auto is_foreign = [this](const fs::path& entry) {
        std::error_code ignored;
        // An entry that cannot be examined exists.
        return !may_remove_(entry) && fs::symlink_status(entry, ignored).type() != fs::file_type::not_found;
    };
    fs::directory_iterator entries(target_, error);
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        if (is_foreign(entries->path()) && is_foreign(entries->path()))
            throw Error(ErrorKind::output,
                        fmt::format("cannot write '{}': the folder holds something else ('{}'); empty it or "
                                    "choose another name",
                                    path_, entries->path().filename().string()));
    }
    if (error && error != std::errc::no_such_file_or_directory)
        throw output_error(path_, error.value());
}

void AtomicDirectory::write(const std::string& name, std::string_view bytes) {
    try {
        AtomicFile file((working_ / name).string());
        file.append(bytes);
        file.commit();
    } catch (const Error& error) {
        // The user does not know the temporary name of the folder.
        std::string text = error.what();
        const std::string working = working_.string();
        for (std::size_t at = 0; (at = text.find(working, at)) != std::string::npos;)
            text.replace(at, working.size(), target_.string());
        throw Error(error.kind(), text);
    }
    bytes_.fetch_add(bytes.size(), std::memory_order_relaxed);
}

void AtomicDirectory::commit() {
    if (working_.empty())
        throw Error(ErrorKind::internal, fmt::format("'{}' was ended twice", path_));
    // Once the folder has its final name, remove_unfinished must not remove its contents.
    if (!unfinished_.withdraw())
        throw Error(ErrorKind::cancelled, "cancelled");
    if (permissions_)
        static_cast<void>(::chmod(working_.c_str(), *permissions_));
    // If the target is missing or an empty folder, renaming is enough.
    if (std::rename(working_.c_str(), target_.c_str()) == 0) {
        working_.clear();
        return;
    }
    if (errno != ENOTEMPTY && errno != EEXIST)
        throw output_error(target_.string(), errno);
    check_replaceable();
    // Both folders exchange their names at once, so that one of them exists at all times.
    if (::renameat2(AT_FDCWD, working_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
        remove_folder(std::exchange(working_, {}));
        return;
    }
    // Not every file system supports the exchange. Otherwise the old folder is renamed first; if the new
    // folder cannot get its name, the old one gets it back.
    const fs::path aside = take_free_name(target_, this_process(), [this](const char* name) {
        if (!fs::exists(fs::symlink_status(name)))
            return std::rename(target_.c_str(), name) == 0;
        errno = EEXIST;
        return false;
    });
    if (aside.empty())
        throw output_error(target_.string(), errno);
    if (std::rename(working_.c_str(), target_.c_str()) != 0) {
        const int system_error = errno;
        if (std::rename(aside.c_str(), target_.c_str()) != 0)
            throw Error(ErrorKind::output,
                        fmt::format("cannot write '{}': what was there is now '{}'", path_, aside.string()));
        throw output_error(target_.string(), system_error);
    }
    working_.clear();
    remove_folder(aside);
}

bool begins_with_magic(const fs::path& path, std::string_view mark) {
    std::error_code ignored;
    if (!fs::is_regular_file(fs::symlink_status(path, ignored)))
        return false;
    std::string begin(mark.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return file && begin == mark;
}

} // namespace lamella
