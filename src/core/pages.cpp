#include "core/pages.hpp"

#include "core/executor.hpp"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

namespace lamella {

namespace {
constexpr std::size_t huge_page = std::size_t{2} << 20;
}

Pages::Pages(std::size_t bytes, Fill fill) {
    if (bytes == 0)
        return;
    bytes_ = bytes;
    if (bytes < huge_page) {
        constexpr std::size_t line = 64;
        data_ = std::aligned_alloc(line, (bytes + line - 1) / line * line);
        if (data_ == nullptr)
            throw std::bad_alloc();
        if (fill == Fill::zero)
            std::memset(data_, 0, bytes);
        return;
    }
    // A fresh mapping is zero. It is one huge page longer than needed, so that the data can start on one; the
    // memory before that is returned.
    if (bytes > ~std::size_t{0} - 2 * huge_page)
        throw std::bad_alloc();
    const std::size_t mapped = bytes + huge_page;
    void* base =
        mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (base == MAP_FAILED)
        throw std::bad_alloc();
    const auto address = reinterpret_cast<std::uintptr_t>(base);
    const std::uintptr_t aligned = (address + huge_page - 1) & ~(huge_page - 1);
    if (aligned != address)
        munmap(base, aligned - address);
    data_ = reinterpret_cast<void*>(aligned); // NOLINT(performance-no-int-to-ptr): alignment of a mapping
    bytes_ = mapped - (aligned - address);
    madvise(data_, bytes_, MADV_HUGEPAGE); // a hint; works without huge pages, too
}

Pages::~Pages() {
    if (bytes_ >= huge_page)
        munmap(data_, bytes_);
    else
        std::free(data_);
}

void make_pages_ready(Executor& executor, void* data, std::size_t bytes) {
    const auto address = reinterpret_cast<std::uintptr_t>(data);
    const std::uintptr_t begin = (address + huge_page - 1) & ~(huge_page - 1);
    const std::uintptr_t end = (address + bytes) & ~(huge_page - 1);
    if (begin >= end)
        return;
    auto* const first = static_cast<std::byte*>(data) + (begin - address);
    madvise(first, end - begin, MADV_HUGEPAGE);
    constexpr std::uint64_t pages_at_once = 2;
    executor.for_chunks((end - begin) / huge_page, pages_at_once,
                        [&](std::uint64_t from, std::uint64_t to, unsigned) {
                            madvise(first + from * huge_page, (to - from) * huge_page, MADV_POPULATE_WRITE);
                        });
}

} // namespace lamella
