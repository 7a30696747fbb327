#include "system/working_folder.hpp"

#include "system/nameless_file.hpp"
#include "system/output_target.hpp"
#include "system/posix/kernel.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace lamella {

namespace fs = std::filesystem;

namespace {

/// Returns false if the name has been removed or replaced in the meantime.
bool is_still(const NativeFile& folder, const char* name) {
    struct stat opened {};
    struct stat named {};
    return ::fstat(static_cast<int>(folder.handle()), &opened) == 0 && ::lstat(name, &named) == 0 &&
           opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

NativeFile open_folder(const char* name) {
    return NativeFile(::open(name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

bool lock(const NativeFile& folder) {
    return ::flock(static_cast<int>(folder.handle()), LOCK_EX | LOCK_NB) == 0;
}

/// Removes the hidden folder unless its process is still running. (A lock ends with its process in any case.)
/// Returns whether the name is free afterwards.
bool remove_abandoned(const char* name, const std::function<bool(const char*)>& may_remove) {
    const NativeFile folder = open_folder(name);
    if (!folder.is_open() || !lock(folder) || !is_still(folder, name) || !may_remove(name))
        return false;
    remove_folder(name);
    struct stat status {};
    return ::lstat(name, &status) != 0;
}

} // namespace

std::string this_machine() {
    const std::string id = boot_id();
    constexpr std::size_t enough = 8;
    return id.size() >= enough ? id.substr(0, enough) : this_process();
}

bool create_locked(const char* name, NativeFile& locked, const std::function<bool(const char*)>& may_remove) {
    constexpr mode_t everybody = 0777; // the umask applies
    if (::mkdir(name, everybody) != 0) {
        if (errno == EEXIST)
            errno = remove_abandoned(name, may_remove) ? EINTR : EEXIST; // try again, or try the next name
        return false;
    }
    locked = open_folder(name);
    if (!locked.is_open() && errno != ENOENT) { // without a lock, other processes would consider the folder
                                                // abandoned
        const int system_error = errno;
        ::rmdir(name);
        errno = system_error;
        return false;
    }
    // If the file system has no locks, no process removes the folder.
    if (locked.is_open() && (lock(locked) || errno != EWOULDBLOCK) && is_still(locked, name))
        return true;
    // Another process considered the folder abandoned before it was locked, and removed it.
    locked.close();
    errno = EEXIST;
    return false;
}

std::optional<unsigned> take_permissions(const fs::path& replaced, const fs::path& working) {
    // A new folder gets permissions from the umask.
    struct stat status {};
    if (::stat(replaced.c_str(), &status) != 0)
        return std::nullopt;
    const bool same_group = ::chown(working.c_str(), static_cast<uid_t>(-1), status.st_gid) == 0;
    const unsigned permissions = kept_permissions(status.st_mode, same_group);
    set_permissions(working, permissions | S_IRWXU);
    return permissions;
}

void set_permissions(const fs::path& folder, unsigned permissions) {
    static_cast<void>(::chmod(folder.c_str(), static_cast<mode_t>(permissions)));
}

bool rename_folder(NativeFile& /*lock*/, const fs::path& folder, const fs::path& name) {
    return std::rename(folder.c_str(), name.c_str()) == 0;
}

bool exchange_folders(const fs::path& one, const fs::path& other) {
    return exchange_names(one.c_str(), other.c_str());
}

bool is_mount_point(const fs::path& folder) {
    return is_mounted(folder.c_str());
}

void remove_folder(const fs::path& folder) {
    static_cast<void>(::chmod(folder.c_str(), S_IRWXU));
    std::error_code ignored;
    fs::remove_all(folder, ignored);
}

} // namespace lamella
