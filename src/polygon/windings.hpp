#pragma once

// Winding numbers for the overlaid rings of two operands; for one operand, the second number is 0.

#include <cstdint>

namespace lamella {

/// The winding numbers of the rings of each operand: how many times these rings run counter-clockwise around
/// a point. For a ring: the amounts that it adds to the winding numbers of its inside if it is
/// counter-clockwise, and subtracts if it is clockwise.
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
