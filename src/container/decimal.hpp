#pragma once

// Fast conversion of numbers to text, independent of locales.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace lamella {

namespace detail {

inline constexpr std::array<char, 200> digit_pairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

inline constexpr std::array<std::uint64_t, 20> powers_of_ten = [] {
    std::array<std::uint64_t, 20> powers{};
    std::uint64_t power = 1;
    for (std::uint64_t& p : powers) {
        p = power;
        power *= 10;
    }
    return powers;
}();

} // namespace detail

/// Length of the longest text of a 64-bit integer with its sign.
inline constexpr std::size_t most_integer_digits = 20;

/// Returns the number of decimal digits of n; 1 for 0.
[[nodiscard]] inline unsigned digit_count(std::uint64_t n) noexcept {
    // 1233 / 4096 is slightly more than log10(2), so this guess is correct or one too high.
    const unsigned guess = static_cast<unsigned>(std::bit_width(n | 1U)) * 1233U >> 12U;
    return guess + 1 - (n < detail::powers_of_ten[guess] && guess > 0 ? 1 : 0);
}

/// Writes n and returns the end. Writes two digits at a time, from the last to the first: divisions by a
/// constant become multiplications.
inline char* put_integer(char* out, std::uint64_t n) noexcept {
    char* const end = out + digit_count(n);
    char* at = end;
    while (n >= 100) {
        at -= 2;
        std::memcpy(at, &detail::digit_pairs[2 * (n % 100)], 2);
        n /= 100;
    }
    if (n >= 10)
        std::memcpy(at - 2, &detail::digit_pairs[2 * n], 2);
    else
        at[-1] = static_cast<char>('0' + n);
    return end;
}

inline char* put_integer(char* out, std::int64_t n) noexcept {
    *out = '-';
    const bool negative = n < 0;
    const auto magnitude = static_cast<std::uint64_t>(n);
    return put_integer(out + (negative ? 1 : 0), negative ? 0 - magnitude : magnitude);
}

/// Writes n thousandths without trailing zeros: "12.34", "-0.005", "7". At most 22 characters.
inline char* put_thousandths(char* out, std::int64_t n) noexcept {
    *out = '-';
    const bool negative = n < 0;
    const auto magnitude = negative ? 0 - static_cast<std::uint64_t>(n) : static_cast<std::uint64_t>(n);
    out = put_integer(out + (negative ? 1 : 0), magnitude / 1000);
    const auto rest = static_cast<unsigned>(magnitude % 1000);
    // All three decimals are written. Those beyond the returned end are overwritten later.
    out[0] = '.';
    out[1] = static_cast<char>('0' + rest / 100);
    std::memcpy(out + 2, &detail::digit_pairs[std::size_t{2} * (rest % 100)], 2);
    const int kept = rest == 0 ? 0 : rest % 10 != 0 ? 4 : rest % 100 != 0 ? 3 : 2;
    return out + kept;
}

/// Writes n thousandths with at least one decimal, such as "7.0", for formats that distinguish real numbers
/// from integers.
inline char* put_real_thousandths(char* out, std::int64_t n) noexcept {
    char* const end = put_thousandths(out, n);
    if (n % 1000 != 0)
        return end;
    end[0] = '.';
    end[1] = '0';
    return end + 2;
}

/// Returns `value` rounded to `most` decimals, with trailing zeros removed down to `least`; zero has no sign.
/// Meant for headers, not for points.
[[nodiscard]] std::string decimal_text(double value, int most = 9, int least = 0);

/// Length of the longest text of a double that `put_shortest` writes.
inline constexpr std::size_t most_double_digits = 24;

/// Writes the shortest text that reads back as the same number, and returns the end. The text has an exponent
/// if that is shorter.
char* put_shortest(char* out, double value) noexcept;
char* put_shortest(char* out, float value) noexcept;
/// Returns the text of `put_shortest` as a string; zero has no sign.
[[nodiscard]] std::string shortest_text(double value);

/// Returns the shortest text that reads back as the same number, without an exponent and with at least one
/// decimal.
[[nodiscard]] std::string exact_decimal_text(double value);

namespace detail {

/// Writes the texts of std::to_chars, with an exponent if that is shorter or never. Used where the standard
/// library has no std::to_chars of floating-point numbers (libc++ before 14).
char* put_shortest_without_library(char* out, double value, bool exponents);
char* put_shortest_without_library(char* out, float value, bool exponents);

} // namespace detail

} // namespace lamella
