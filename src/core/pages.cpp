#include "core/pages.hpp"

#include "core/executor.hpp"
#include "core/machine.hpp"

#include <cstdint>
#include <cstring>
#include <new>

namespace lamella {

namespace {
constexpr std::align_val_t line{64};
}

Pages::Pages(std::size_t bytes, Fill fill) {
    if (bytes == 0)
        return;
    if (bytes >= large_page) {
        const LargeMemory memory = take_large_memory(bytes);
        if (memory.data == nullptr)
            throw std::bad_alloc();
        data_ = memory.data;
        bytes_ = memory.bytes;
        return;
    }
    data_ = ::operator new(bytes, line);
    bytes_ = bytes;
    if (fill == Fill::zero)
        std::memset(data_, 0, bytes);
}

Pages::~Pages() {
    if (bytes_ >= large_page)
        release_large_memory({data_, bytes_});
    else
        ::operator delete(data_, line);
}

void make_pages_ready(Executor& executor, void* data, std::size_t bytes) {
    const auto address = reinterpret_cast<std::uintptr_t>(data);
    const std::uintptr_t begin = (address + large_page - 1) & ~(large_page - 1);
    const std::uintptr_t end = (address + bytes) & ~(large_page - 1);
    if (begin >= end)
        return;
    auto* const first = static_cast<std::byte*>(data) + (begin - address);
    prefer_large_pages(first, end - begin);
    constexpr std::uint64_t pages_at_once = 2;
    executor.for_chunks((end - begin) / large_page, pages_at_once,
                        [&](std::uint64_t from, std::uint64_t to, unsigned) {
                            provide_pages(first + from * large_page, (to - from) * large_page);
                        });
}

} // namespace lamella
