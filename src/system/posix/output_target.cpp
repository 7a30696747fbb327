#include "system/output_target.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <deque>
#include <filesystem>
#include <system_error>

namespace lamella {

namespace fs = std::filesystem;

namespace {

constexpr int most_links = 40; // the limit of Linux

// Returns whether a path, such as /dev/stdout, names a file that is already open. Such a file must not be
// replaced, because its owner would no longer have it.
bool names_open_file(const fs::path& path) {
    std::error_code error;
    const std::string text = fs::absolute(path, error).lexically_normal().string();
    return text.starts_with("/proc/") || text.starts_with("/dev/fd/") || text == "/dev/stdout" ||
           text == "/dev/stderr";
}

// Follows a chain of symbolic links to its end, even if no file exists there.
OutputTarget follow_links(const std::string& path) {
    fs::path current = path;
    for (int i = 0; i < most_links; ++i) {
        if (names_open_file(current))
            return {.path = {}, .in_place = true};
        struct stat status {};
        if (::lstat(current.c_str(), &status) != 0 || !S_ISLNK(status.st_mode))
            return {.path = current.string()};
        std::error_code error;
        const fs::path next = fs::read_symlink(current, error);
        if (error)
            return {.path = {}, .error = error.value()};
        current = current.parent_path() / next; // an absolute link replaces the folder
    }
    return {.path = {}, .error = ELOOP};
}

// Returns whether somebody else made a link with this status in the folder, and others can write there.
bool is_foreign(const struct stat& link, const fs::path& folder) {
    struct stat status {};
    if (::stat(folder.empty() ? "." : folder.c_str(), &status) != 0)
        return false; // writing fails, too
    const bool others_write = (status.st_mode & (S_IWGRP | S_IWOTH)) != 0;
    return others_write && link.st_uid != ::geteuid() && link.st_uid != status.st_uid;
}

} // namespace

bool leads_through_foreign_link(const std::string& path) {
    const fs::path whole = path;
    std::deque<fs::path> rest(whole.begin(), whole.end());
    fs::path at;
    for (int links = 0; !rest.empty() && links <= most_links;) {
        const fs::path next = at / rest.front();
        rest.pop_front();
        struct stat status {};
        if (::lstat(next.c_str(), &status) != 0)
            return false; // nothing is there yet
        if (!S_ISLNK(status.st_mode)) {
            at = next;
            continue;
        }
        if (is_foreign(status, at))
            return true;
        std::error_code error;
        const fs::path target = fs::read_symlink(next, error);
        if (error)
            return false;
        ++links;
        at = target.is_absolute() ? fs::path() : at;
        rest.insert(rest.begin(), target.begin(), target.end());
    }
    return false;
}

OutputTarget find_target(const std::string& path) {
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        return {.path = {}, .error = EISDIR};
    if (path.ends_with('/'))
        return {.path = {}, .error = exists ? EISDIR : ENOENT};
    OutputTarget target = follow_links(path);
    if (exists && !S_ISREG(status.st_mode))
        target.in_place = true;
    return target;
}

std::string device_named(const std::string& /*path*/) {
    return {};
}

Replaces replaced_at(const std::string& target) {
    struct stat status {};
    if (::stat(target.c_str(), &status) != 0) // the temporary name may be shorter
        return errno == ENAMETOOLONG ? Replaces::unknown : Replaces::nothing;
    if (::access(target.c_str(), W_OK) == 0)
        return Replaces::file;
    return errno == EACCES ? Replaces::protected_file : Replaces::unknown;
}

void keep_permissions(const NativeFile& replacement, const std::string& target) {
    struct stat status {};
    if (::stat(target.c_str(), &status) != 0)
        return;
    const int descriptor = static_cast<int>(replacement.handle());
    const bool same_group = ::fchown(descriptor, static_cast<uid_t>(-1), status.st_gid) == 0;
    static_cast<void>(
        ::fchmod(descriptor, static_cast<mode_t>(kept_permissions(status.st_mode, same_group))));
}

} // namespace lamella
