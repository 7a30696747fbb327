#include "system/posix/kernel.hpp"

#include <fcntl.h>
#include <sys/attr.h>
#include <sys/mount.h>
#include <sys/sysctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace lamella {

bool exchange_names(const char* one, const char* other) noexcept {
    return ::renamex_np(one, other, RENAME_SWAP) == 0;
}

bool is_mounted(const char* folder) noexcept {
    struct statfs file_system {};
    std::array<char, PATH_MAX> path{};
    return ::statfs(folder, &file_system) == 0 && ::realpath(folder, path.data()) != nullptr &&
           std::strcmp(path.data(), file_system.f_mntonname) == 0;
}

void unlink_entries(int folder) noexcept {
    // The attributes of an entry as the system packs them: those that are there, then the name.
    struct Entry {
        std::uint32_t length;
        attribute_set_t present;
        attrreference_t name;
    };
    attrlist wanted{};
    wanted.bitmapcount = ATTR_BIT_MAP_COUNT;
    wanted.commonattr = ATTR_CMN_RETURNED_ATTRS | ATTR_CMN_NAME;
    alignas(Entry) char entries[4096];
    for (;;) {
        // A system call, because opendir allocates memory.
        const int count = ::getattrlistbulk(folder, &wanted, entries, sizeof entries, 0);
        if (count <= 0)
            return;
        const char* at = entries;
        for (int i = 0; i < count; ++i) {
            Entry entry;
            std::memcpy(&entry, at, sizeof entry);
            ::unlinkat(folder, at + offsetof(Entry, name) + entry.name.attr_dataoffset, 0);
            at += entry.length;
        }
    }
}

std::string boot_id() {
    std::array<char, 64> id{};
    std::size_t size = id.size() - 1;
    return ::sysctlbyname("kern.bootsessionuuid", id.data(), &size, nullptr, 0) == 0 ? id.data() : "";
}

int reserve_blocks(int descriptor, std::uint64_t bytes) noexcept {
    fstore_t space{};
    space.fst_flags = F_ALLOCATEALL;
    space.fst_posmode = F_PEOFPOSMODE;
    space.fst_length = static_cast<off_t>(bytes);
    return ::fcntl(descriptor, F_PREALLOCATE, &space) == 0 ? 0 : errno;
}

void punch_hole(int descriptor, std::uint64_t offset, std::uint64_t bytes) noexcept {
    struct statfs file_system {};
    if (::fstatfs(descriptor, &file_system) != 0 || file_system.f_bsize == 0)
        return;
    // Only whole blocks can be freed.
    const std::uint64_t block = file_system.f_bsize;
    const std::uint64_t first = (offset + block - 1) / block * block;
    const std::uint64_t end = (offset + bytes) / block * block;
    if (first >= end)
        return;
    fpunchhole_t hole{};
    hole.fp_offset = static_cast<off_t>(first);
    hole.fp_length = static_cast<off_t>(end - first);
    ::fcntl(descriptor, F_PUNCHHOLE, &hole);
}

} // namespace lamella
