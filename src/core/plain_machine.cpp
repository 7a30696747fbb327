// Implements machine.hpp with the standard library alone, for operating systems other than those of
// system/machine.cpp.

#include "core/machine.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <thread>

namespace lamella {

namespace {
constexpr std::align_val_t alignment{large_page};
}

unsigned usable_processors() noexcept {
    return std::max(1U, std::thread::hardware_concurrency());
}

LargeMemory take_large_memory(std::size_t bytes) noexcept {
    // Rounding up to the alignment must not wrap around.
    if (bytes > ~std::size_t{0} / 2)
        return {};
    void* const data = ::operator new(bytes, alignment, std::nothrow);
    if (data == nullptr)
        return {};
    std::memset(data, 0, bytes);
    return {data, bytes};
}

void release_large_memory(LargeMemory memory) noexcept {
    ::operator delete(memory.data, alignment);
}

void prefer_large_pages(void* /*data*/, std::size_t /*bytes*/) noexcept {}

void provide_pages(void* /*data*/, std::size_t /*bytes*/) noexcept {}

} // namespace lamella
