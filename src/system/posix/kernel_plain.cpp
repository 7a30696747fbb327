#include "system/posix/kernel.hpp"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace lamella {

bool exchange_names(const char* /*one*/, const char* /*other*/) noexcept {
    errno = EOPNOTSUPP;
    return false;
}

bool is_mounted(const char* folder) noexcept {
    // Bind mounts of the same file system are not detected.
    struct stat status {};
    struct stat parent {};
    const std::string above = std::string(folder) + "/..";
    return ::stat(folder, &status) == 0 && ::stat(above.c_str(), &parent) == 0 && S_ISDIR(status.st_mode) &&
           (status.st_dev != parent.st_dev || status.st_ino == parent.st_ino);
}

void unlink_entries(int folder) noexcept {
    DIR* const entries = ::fdopendir(::dup(folder));
    if (entries == nullptr)
        return;
    while (const dirent* const entry = ::readdir(entries))
        ::unlinkat(folder, entry->d_name, 0); // "." and ".." are refused
    ::closedir(entries);
}

std::string boot_id() {
    return {};
}

int reserve_blocks(int /*descriptor*/, std::uint64_t /*bytes*/) noexcept {
    return EOPNOTSUPP;
}

void punch_hole(int /*descriptor*/, std::uint64_t /*offset*/, std::uint64_t /*bytes*/) noexcept {}

} // namespace lamella
