#include "system/posix/kernel.hpp"

#include <sys/mman.h>

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

bool is_path_only(int /*descriptor*/) noexcept {
    return false;
}

void prefer_read_ahead(int /*descriptor*/) noexcept {}

void* resize_mapping(void* data, std::size_t size, std::size_t new_size) noexcept {
    void* const moved = ::mmap(nullptr, new_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (moved == MAP_FAILED)
        return moved;
    std::memcpy(moved, data, std::min(size, new_size));
    ::munmap(data, size);
    return moved;
}

} // namespace lamella
