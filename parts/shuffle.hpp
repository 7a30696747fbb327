#pragma once

// Random order that is the same on every machine, unlike std::shuffle and the standard distributions.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace lamella {

/// SplitMix64 (Steele, Lea, Flood 2014).
class RandomNumbers {
  public:
    explicit RandomNumbers(std::uint64_t seed) noexcept : state_(seed) {}

    [[nodiscard]] std::uint64_t next() noexcept {
        state_ += 0x9e3779b97f4a7c15;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }

    /// Returns a number in [0, n), n below about 2^40: the bias from not rejecting is negligible.
    [[nodiscard]] std::uint64_t below(std::uint64_t n) noexcept {
        __extension__ using Wide = unsigned __int128;
        return static_cast<std::uint64_t>((static_cast<Wide>(next()) * n) >> 64);
    }

  private:
    std::uint64_t state_;
};

/// The shuffle of Fisher and Yates.
template <class T>
void shuffle(std::span<T> values, std::uint64_t seed) {
    RandomNumbers random(seed);
    for (std::size_t n = values.size(); n > 1; --n)
        std::swap(values[n - 1], values[random.below(n)]);
}

} // namespace lamella
