#include "system/growing_memory.hpp"

#include "system/posix/kernel.hpp"

#include <sys/mman.h>

#include <cassert>
#include <new>

namespace lamella {

GrowingMemory::GrowingMemory() : capacity_(std::size_t{1} << 20) {
    void* data = mmap(nullptr, capacity_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (data == MAP_FAILED)
        throw std::bad_alloc();
    data_ = static_cast<std::byte*>(data);
}

GrowingMemory::~GrowingMemory() {
    munmap(data_, capacity_);
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
    void* const moved = resize_mapping(data_, capacity_, bytes);
    if (moved == MAP_FAILED)
        throw std::bad_alloc();
    data_ = static_cast<std::byte*>(moved);
    capacity_ = bytes;
}

} // namespace lamella
