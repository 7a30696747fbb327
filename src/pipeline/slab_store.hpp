#pragma once

// Triangles on their way to the slabs that they touch.

#include "lamella/mesh/triangle_soup.hpp"

#include "container/spill_file.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lamella {

/// Heaps of triangles whose sizes are known beforehand, each in one stretch of a spill file, or of memory
/// where there is room for all of them.
class SlabStore {
  public:
    /// `sizes`: the triangles of each heap.
    SlabStore(std::span<const std::uint64_t> sizes, bool in_memory);

    /// From any number of threads. False when the heap is full: then the sizes were wrong.
    [[nodiscard]] bool add(std::size_t heap, std::span<const Triangle3f> triangles);
    /// Whether all heaps have as many triangles as they were said to have.
    [[nodiscard]] bool full() const noexcept;
    /// Brings a full heap into memory, in any order. Each once: its room on the disk is given back.
    [[nodiscard]] TriangleSoup take(std::size_t heap, Executor& executor);

  private:
    struct Heap {
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
        std::atomic<std::uint64_t> next{0};
    };

    std::vector<Heap> heaps_;
    std::unique_ptr<SpillFile> file_;                     ///< or
    std::shared_ptr<const PageArray<Triangle3f>> memory_; ///< either
};

} // namespace lamella
