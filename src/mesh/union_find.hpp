#pragma once

// Disjoint sets that all workers may join at once, without locks (Anderson and Woll 1991). The lowest member
// of a set identifies it, so the result does not depend on the order in which sets were joined.

#include "core/pages.hpp"

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace lamella {

class UnionFind {
  public:
    /// Begins with the numbers below `size`, each a set of its own.
    explicit UnionFind(std::size_t size) : up_(size, Fill::zero) {}

    /// Returns the lowest member of i's set once all joins are done; until then, some member of the set.
    [[nodiscard]] std::uint32_t find(std::uint32_t i) const noexcept {
        for (;;) {
            const std::uint32_t parent = above(i);
            if (parent == i)
                return i;
            const std::uint32_t grandparent = above(parent);
            // Halve the path for later searches. If another thread changes it at the same time, the path only
            // stays longer.
            if (grandparent != parent)
                up_[i].store(i - grandparent, std::memory_order_relaxed);
            i = grandparent;
        }
    }

    void join(std::uint32_t a, std::uint32_t b) const noexcept {
        for (;;) {
            a = find(a);
            b = find(b);
            if (a == b)
                return;
            if (a < b)
                std::swap(a, b);
            std::uint32_t root = 0;
            if (up_[a].compare_exchange_weak(root, a - b, std::memory_order_relaxed))
                return;
        }
    }

  private:
    [[nodiscard]] std::uint32_t above(std::uint32_t i) const noexcept {
        assert(i < up_.size());
        return i - up_[i].load(std::memory_order_relaxed);
    }

    /// Difference between a member and its parent; 0 at the root.
    PageArray<std::atomic<std::uint32_t>> up_;
};

} // namespace lamella
