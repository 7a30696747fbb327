#include "system/growing_memory.hpp"

#include "system/memory_size.hpp"

#include <windows.h>

#include <algorithm>
#include <cassert>
#include <new>

namespace lamella {

namespace {

constexpr std::size_t first_size = std::size_t{1} << 20;

/// Address space is reserved at once, and memory is provided as it is needed.
std::size_t reserved_size() {
    constexpr std::uint64_t least = std::uint64_t{1} << 32;
    return std::max(2 * memory_size(), least);
}

} // namespace

GrowingMemory::GrowingMemory() : capacity_(first_size) {
    void* const data = VirtualAlloc(nullptr, reserved_size(), MEM_RESERVE, PAGE_READWRITE);
    if (data == nullptr)
        throw std::bad_alloc();
    if (VirtualAlloc(data, capacity_, MEM_COMMIT, PAGE_READWRITE) == nullptr) {
        VirtualFree(data, 0, MEM_RELEASE);
        throw std::bad_alloc();
    }
    data_ = static_cast<std::byte*>(data);
}

GrowingMemory::~GrowingMemory() {
    VirtualFree(data_, 0, MEM_RELEASE);
}

std::span<std::byte> GrowingMemory::room() {
    if (size_ == capacity_)
        resize(2 * capacity_);
    assert(size_ < capacity_);
    return {data_ + size_, capacity_ - size_};
}

void GrowingMemory::trim() {
    assert(size_ > 0 && size_ <= capacity_);
    resize(size_);
}

void GrowingMemory::resize(std::size_t bytes) {
    if (bytes > capacity_) {
        if (bytes > reserved_size() || VirtualAlloc(data_, bytes, MEM_COMMIT, PAGE_READWRITE) == nullptr)
            throw std::bad_alloc();
    } else {
        constexpr std::size_t page = 4096;
        const std::size_t kept = (bytes + page - 1) / page * page;
        if (kept < capacity_)
            VirtualFree(data_ + kept, capacity_ - kept, MEM_DECOMMIT);
    }
    capacity_ = bytes;
}

} // namespace lamella
