#pragma once

// The exact sign of a sum of products of doubles, computed in fixed point that is wide enough for all finite
// numbers.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace lamella {

/// A product of `factors` (two or three) doubles, negated if `minus`.
template <std::size_t factors>
struct SignedProduct {
    std::array<double, factors> factor;
    bool minus = false;
};

namespace exact_sum {

__extension__ using Wide = unsigned __int128;

/// |product| = mantissa * 2^exponent
struct Magnitude {
    std::array<std::uint64_t, 3> mantissa; ///< lowest word first
    int exponent;
    bool negative;
};

template <std::size_t factors>
[[nodiscard]] Magnitude magnitude(const SignedProduct<factors>& product) noexcept {
    static_assert(factors == 2 || factors == 3);
    Magnitude out{{}, 0, product.minus};
    std::array<std::uint64_t, 3> m{1, 1, 1};
    for (std::size_t k = 0; k < factors; ++k) {
        int exponent = 0;
        const double fraction = std::frexp(std::abs(product.factor[k]), &exponent);
        m[k] = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
        out.exponent += exponent - 53;
        out.negative = out.negative != std::signbit(product.factor[k]);
    }
    const Wide two = static_cast<Wide>(m[0]) * m[1];
    const Wide low = static_cast<Wide>(static_cast<std::uint64_t>(two)) * m[2];
    const Wide high = static_cast<Wide>(static_cast<std::uint64_t>(two >> 64)) * m[2] + (low >> 64);
    out.mantissa = {static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high),
                    static_cast<std::uint64_t>(high >> 64)};
    return out;
}

} // namespace exact_sum

/// Returns the sign of the sum: -1, 0 or 1. Requires at most 2^20 products of finite numbers.
template <std::size_t factors, std::size_t n>
[[nodiscard]] int sign_of_sum(const std::array<SignedProduct<factors>, n>& products) noexcept {
    using exact_sum::Magnitude;
    std::array<Magnitude, n> terms;
    std::size_t count = 0;
    int unit = std::numeric_limits<int>::max();
    int top = std::numeric_limits<int>::min();
    for (const SignedProduct<factors>& product : products) {
        bool zero = false;
        for (const double factor : product.factor)
            zero = zero || factor == 0;
        if (zero)
            continue;
        terms[count] = exact_sum::magnitude(product);
        unit = std::min(unit, terms[count].exponent);
        top = std::max(top, terms[count].exponent);
        ++count;
    }
    if (count == 0)
        return 0;

    // Digits of 32 bits are stored in 64 bits with a sign, so carries can wait until the end. Mantissas are
    // normalised, so the exponent of a factor ranges from -1073 - 53 to 1024 - 53.
    constexpr std::size_t largest_shift = factors * (1024 + 1073);
    constexpr std::uint64_t low = 0xffffffff;
    std::array<std::int64_t, largest_shift / 32 + 8> digits; // cleared as far as used
    const std::size_t used = static_cast<std::size_t>(top - unit) / 32 + 8;
    std::fill_n(digits.begin(), used, 0);
    for (const Magnitude& term : std::span(terms).first(count)) {
        const auto shift = static_cast<std::size_t>(term.exponent - unit);
        std::size_t digit = shift / 32;
        std::uint64_t carry = 0;
        for (std::size_t k = 0; k < 6; ++k, ++digit) {
            const std::uint64_t part = term.mantissa[k / 2] >> (k % 2 == 0 ? 0 : 32) & low;
            const std::uint64_t moved = (part << shift % 32) + carry; // below 2^64: the carry has < 32 bits
            const auto value = static_cast<std::int64_t>(moved & low);
            digits[digit] += term.negative ? -value : value;
            carry = moved >> 32;
        }
        const auto value = static_cast<std::int64_t>(carry);
        digits[digit] += term.negative ? -value : value;
    }
    std::int64_t carry = 0;
    bool nonzero = false;
    for (const std::int64_t digit : std::span(digits).first(used)) {
        const std::int64_t value = digit + carry;
        carry = value >> 32;
        nonzero = nonzero || (value & static_cast<std::int64_t>(low)) != 0;
    }
    return carry < 0 ? -1 : static_cast<int>(nonzero || carry > 0);
}

} // namespace lamella
