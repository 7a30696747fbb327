#include "system/posix/kernel.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace lamella {

int open_nameless(const std::string& /*folder*/, mode_t /*permissions*/) noexcept {
    errno = EOPNOTSUPP;
    return -1;
}

bool can_link_nameless(int /*descriptor*/) noexcept {
    return false;
}

bool link_nameless(int /*descriptor*/, const char* /*name*/) noexcept {
    errno = EOPNOTSUPP;
    return false;
}

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

bool is_path_only(int /*descriptor*/) noexcept {
    return false;
}

void prefer_read_ahead(int /*descriptor*/) noexcept {}

int reserve_blocks(int /*descriptor*/, std::uint64_t /*bytes*/) noexcept {
    return EOPNOTSUPP;
}

void punch_hole(int /*descriptor*/, std::uint64_t /*offset*/, std::uint64_t /*bytes*/) noexcept {}

void* resize_mapping(void* data, std::size_t size, std::size_t new_size) noexcept {
    void* const moved = ::mmap(nullptr, new_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (moved == MAP_FAILED)
        return moved;
    std::memcpy(moved, data, std::min(size, new_size));
    ::munmap(data, size);
    return moved;
}

} // namespace lamella
