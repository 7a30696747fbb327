#include "system/posix/kernel.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

namespace lamella {

namespace {

// A path that leads to an open file, which need not have another one.
struct DescriptorPath {
    explicit DescriptorPath(int descriptor) {
        constexpr std::string_view folder = "/proc/self/fd/";
        folder.copy(text.data(), folder.size());
        std::to_chars(text.data() + folder.size(), text.data() + text.size() - 1, descriptor);
    }
    std::array<char, 32> text{};
};

} // namespace

int open_nameless(const std::string& folder, mode_t permissions) noexcept {
    int descriptor = -1;
    do
        descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, permissions);
    while (descriptor < 0 && errno == EINTR);
    // File systems and kernels without O_TMPFILE report one of these.
    if (descriptor < 0 && (errno == EISDIR || errno == EINVAL))
        errno = EOPNOTSUPP;
    return descriptor;
}

bool can_link_nameless(int descriptor) noexcept {
    return ::access(DescriptorPath(descriptor).text.data(), F_OK) == 0; // there may be no /proc
}

bool link_nameless(int descriptor, const char* name) noexcept {
    return ::linkat(AT_FDCWD, DescriptorPath(descriptor).text.data(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
}

bool exchange_names(const char* one, const char* other) noexcept {
    return ::renameat2(AT_FDCWD, one, AT_FDCWD, other, RENAME_EXCHANGE) == 0;
}

bool is_mounted(const char* folder) noexcept {
    struct statx status {};
    return ::statx(AT_FDCWD, folder, 0, STATX_TYPE, &status) == 0 &&
           (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

void unlink_entries(int folder) noexcept {
    alignas(dirent64) char entries[4096];
    for (;;) {
        // The system call itself, because opendir allocates memory.
        const long size = ::syscall(SYS_getdents64, folder, entries, sizeof entries);
        if (size <= 0)
            return;
        for (long at = 0; at < size;) {
            const char* const entry = entries + at;
            unsigned short length = 0;
            std::memcpy(&length, entry + offsetof(dirent64, d_reclen), sizeof length);
            ::unlinkat(folder, entry + offsetof(dirent64, d_name), 0); // "." and ".." are refused
            at += length;
        }
    }
}

std::string boot_id() {
    std::ifstream file("/proc/sys/kernel/random/boot_id");
    std::string id;
    return std::getline(file, id) ? id : std::string();
}

bool is_path_only(int descriptor) noexcept {
    return (::fcntl(descriptor, F_GETFL) & O_PATH) != 0;
}

void prefer_read_ahead(int descriptor) noexcept {
    ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_SEQUENTIAL); // doubles the read-ahead from a cold disk
}

int reserve_blocks(int descriptor, std::uint64_t bytes) noexcept {
    return ::fallocate(descriptor, 0, 0, static_cast<off_t>(bytes)) == 0 ? 0 : errno;
}

void punch_hole(int descriptor, std::uint64_t offset, std::uint64_t bytes) noexcept {
    ::fallocate(descriptor, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset),
                static_cast<off_t>(bytes));
}

void* resize_mapping(void* data, std::size_t size, std::size_t new_size) noexcept {
    return ::mremap(data, size, new_size, MREMAP_MAYMOVE);
}

} // namespace lamella
