#pragma once

// Where a ring starts in normal form.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <span>

namespace lamella {

/// The start of the lexicographically smallest rotation of a ring; 0 for an empty one. O(n), also for
/// periodic rings: of two candidate starts the larger one is ruled out together with all that its comparison
/// passed over.
[[nodiscard]] inline std::size_t least_rotation(std::span<const Point2> ring) noexcept {
    const std::size_t n = ring.size();
    std::size_t a = 0;
    std::size_t b = 1;
    std::size_t equal = 0;
    while (a < n && b < n && equal < n) {
        const Point2& p = ring[(a + equal) % n];
        const Point2& q = ring[(b + equal) % n];
        if (p == q) {
            ++equal;
            continue;
        }
        (q < p ? a : b) += equal + 1;
        if (a == b)
            ++b;
        equal = 0;
    }
    return a < b ? a : b;
}

} // namespace lamella
