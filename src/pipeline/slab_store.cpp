#include "pipeline/slab_store.hpp"

#include <algorithm>
#include <cstring>

namespace lamella {

SlabStore::SlabStore(std::span<const std::uint64_t> sizes, bool in_memory) : heaps_(sizes.size()) {
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        heaps_[i].begin = heaps_[i].next = total;
        heaps_[i].end = total += sizes[i];
    }
    if (in_memory)
        memory_ = std::make_shared<const PageArray<Triangle3f>>(total);
    else
        file_ = std::make_unique<SpillFile>(total * sizeof(Triangle3f));
}

bool SlabStore::add(std::size_t heap, std::span<const Triangle3f> triangles) {
    const std::uint64_t at = heaps_[heap].next.fetch_add(triangles.size(), std::memory_order_relaxed);
    if (at + triangles.size() > heaps_[heap].end)
        return false;
    if (memory_)
        std::copy(triangles.begin(), triangles.end(), memory_->data() + at);
    else
        file_->write(at * sizeof(Triangle3f), std::as_bytes(triangles));
    return true;
}

bool SlabStore::full() const noexcept {
    return std::ranges::all_of(heaps_, [](const Heap& heap) { return heap.next == heap.end; });
}

TriangleSoup SlabStore::take(std::size_t heap, Executor& executor) {
    const Heap& from = heaps_[heap];
    const std::uint64_t count = from.end - from.begin;
    if (memory_)
        return {memory_, reinterpret_cast<const std::byte*>(memory_->data() + from.begin), sizeof(Triangle3f),
                count};
    const auto memory = std::make_shared<const PageArray<Triangle3f>>(count);
    constexpr std::uint64_t at_once = std::uint64_t{1} << 15;
    executor.for_chunks(count, at_once, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        file_->read((from.begin + begin) * sizeof(Triangle3f),
                    std::as_writable_bytes(memory->span().subspan(begin, end - begin)));
    });
    executor.check_cancelled();
    file_->forget(from.begin * sizeof(Triangle3f), count * sizeof(Triangle3f));
    return {memory, reinterpret_cast<const std::byte*>(memory->data()), sizeof(Triangle3f), count};
}

} // namespace lamella
