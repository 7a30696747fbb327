#pragma once

// Winding numbers where the rings of two operands lie over one another; of one operand, the second are 0.

#include <cstdint>

namespace lamella {

/// How many times rings run counter-clockwise around a place, those of either operand by themselves. Of a
/// ring: what it adds to those of its inside where it runs counter-clockwise; clockwise, it takes that away.
struct Windings {
    std::int64_t first = 0;
    std::int64_t second = 0;

    [[nodiscard]] constexpr std::int64_t sum() const noexcept { return first + second; }
    constexpr Windings& operator+=(const Windings& other) noexcept {
        first += other.first;
        second += other.second;
        return *this;
    }
    friend constexpr Windings operator*(std::int64_t times, const Windings& w) noexcept {
        return {times * w.first, times * w.second};
    }
    friend constexpr Windings operator+(Windings a, const Windings& b) noexcept { return a += b; }
    friend constexpr Windings operator-(const Windings& w) noexcept { return -1 * w; }
    friend constexpr bool operator==(const Windings&, const Windings&) = default;
};

} // namespace lamella
