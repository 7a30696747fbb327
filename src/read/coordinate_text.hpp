#pragma once

// Numbers of text files: 1, -1.5, .5, 1., 2.5e-3. Never with the locale's comma.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace lamella {

[[nodiscard]] constexpr bool is_blank(char c) noexcept {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

[[nodiscard]] constexpr bool is_line_end(char c) noexcept {
    return c == '\n' || c == '\r';
}

/// The word that begins here: up to a blank or the end.
[[nodiscard]] inline std::string_view word_at(const char* at, const char* end) noexcept {
    const char* stop = at;
    while (stop != end && !is_blank(*stop))
        ++stop;
    return {at, static_cast<std::size_t>(stop - at)};
}

namespace coordinate_text {

/// Powers of ten that a double holds exactly.
inline constexpr std::array<double, 23> powers_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                         1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                         1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Whether rounding this double to a float is rounding what it was rounded from. It is not where the double
/// lies half-way between two floats, so that which of them is nearer was lost.
[[nodiscard]] inline bool rounds_once_more(double value) noexcept {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    constexpr std::uint64_t below_a_float = (std::uint64_t{1} << 29) - 1;
    return (bits & below_a_float) != std::uint64_t{1} << 28;
}

/// Whatever `parse_coordinate` cannot read at once: many digits, large exponents, NaN, infinity, no number.
[[nodiscard]] const char* parse_unusual(const char* at, const char* end, double& value) noexcept;
[[nodiscard]] const char* parse_unusual(const char* at, const char* end, float& value) noexcept;

} // namespace coordinate_text

/// Reads the word that begins at `at` (not blank, not the end) as a number, rounded once, to the nearest.
/// Returns where the word ends, or null when it is no number. The many ways to write NaN give NaN, numbers
/// beyond the range of T infinity. T is float or double.
///
/// Most numbers of mesh files have few digits: m / 10^k with m below 2^53 and k up to 22 is one division of
/// two exact doubles, thus rounded once; it takes half the time of std::from_chars, which reads the others.
template <class T>
[[nodiscard]] inline const char* parse_coordinate(const char* at, const char* end, T& value) noexcept {
    const char* const word = at;
    const bool negative = *at == '-';
    if (negative || *at == '+')
        ++at;
    const char* const digits_begin = at;
    std::uint64_t mantissa = 0;
    const auto take_digits = [&] {
        while (at != end && static_cast<unsigned char>(*at - '0') < 10)
            mantissa = mantissa * 10 + static_cast<unsigned char>(*at++ - '0');
    };
    take_digits();
    std::int64_t digits = at - digits_begin;
    std::int64_t exponent = 0;
    if (at != end && *at == '.') {
        const char* const fraction = ++at;
        take_digits();
        exponent = fraction - at;
        digits -= exponent;
    }
    if (at != end && (*at == 'e' || *at == 'E')) {
        // One or two digits.
        const char* power_at = at + 1;
        const bool below = power_at != end && *power_at == '-';
        if (below || (power_at != end && *power_at == '+'))
            ++power_at;
        std::int64_t power = 0;
        const char* const power_begin = power_at;
        for (; power_at != end && static_cast<unsigned char>(*power_at - '0') < 10 && power < 1000;
             ++power_at)
            power = power * 10 + static_cast<unsigned char>(*power_at - '0');
        if (power_at == power_begin)
            return coordinate_text::parse_unusual(word, end, value);
        exponent += below ? -power : power;
        at = power_at;
    }
    constexpr std::int64_t most_digits = 19; // so many always fit 64 bits
    constexpr std::int64_t most_power = 22;
    const bool ends = at == end || is_blank(*at);
    if (!ends || digits == 0 || digits > most_digits || mantissa > std::uint64_t{1} << 53 ||
        exponent > most_power || exponent < -most_power)
        return coordinate_text::parse_unusual(word, end, value);
    const auto whole = static_cast<double>(mantissa);
    const double size = exponent < 0
                            ? whole / coordinate_text::powers_of_ten[static_cast<std::size_t>(-exponent)]
                            : whole * coordinate_text::powers_of_ten[static_cast<std::size_t>(exponent)];
    if (std::is_same_v<T, float> && !coordinate_text::rounds_once_more(size))
        return coordinate_text::parse_unusual(word, end, value);
    value = static_cast<T>(negative ? -size : size);
    return at;
}

/// What to expect instead of a word that is no number.
[[nodiscard]] std::string_view expected_instead(std::string_view word) noexcept;

} // namespace lamella
