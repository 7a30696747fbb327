#pragma once

// Pseudo-random numbers that are the same on every machine.

#include <cstdint>
#include <initializer_list>

namespace lamella {

/// Returns a hash of the seed and the numbers: applies the finalizer of splitmix64 (Steele, Lea, Flood 2014)
/// once for each number.
[[nodiscard]] constexpr std::uint64_t seeded(std::uint64_t seed,
                                             std::initializer_list<std::uint64_t> numbers) noexcept {
    for (const std::uint64_t number : numbers) {
        seed += number + 0x9e3779b97f4a7c15;
        seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9;
        seed = (seed ^ (seed >> 27)) * 0x94d049bb133111eb;
        seed ^= seed >> 31;
    }
    return seed;
}

} // namespace lamella
