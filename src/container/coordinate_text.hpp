#pragma once

// Reads numbers in text files: 1, -1.5, .5, 1., 2.5e-3. The decimal separator never depends on the locale.

#include "container/decimal_text.hpp"

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

/// Returns the word that begins here: up to a blank or the end.
[[nodiscard]] inline std::string_view word_at(const char* at, const char* end) noexcept {
    const char* stop = at;
    while (stop != end && !is_blank(*stop))
        ++stop;
    return {at, static_cast<std::size_t>(stop - at)};
}

namespace coordinate_text {

/// Returns whether rounding `value`, a decimal number rounded to double, to a float gives the float nearest
/// to that decimal number. This is unknown if `value` is half-way between two floats.
[[nodiscard]] inline bool rounds_once_more(double value) noexcept {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    constexpr std::uint64_t below_a_float = (std::uint64_t{1} << 29) - 1;
    return (bits & below_a_float) != std::uint64_t{1} << 28;
}

/// Reads words that `parse_coordinate` cannot read quickly: many digits, large exponents, NaN, infinity, and
/// words that are not numbers.
[[nodiscard]] const char* parse_unusual(const char* at, const char* end, double& value) noexcept;
[[nodiscard]] const char* parse_unusual(const char* at, const char* end, float& value) noexcept;

} // namespace coordinate_text

/// Reads the word that begins at `at` (not blank, not the end) as a number, rounded once, to the nearest.
/// Returns the end of the word, or null if it is not a number. All spellings of NaN give NaN; numbers beyond
/// the range of T give infinity. T is float or double.
///
/// Most numbers are read by one division (see DecimalDigits), in half the time of std::from_chars, which
/// reads the others.
template <class T>
[[nodiscard]] inline const char* parse_coordinate(const char* at, const char* end, T& value) noexcept {
    const char* const word = at;
    const bool negative = *at == '-';
    if (negative || *at == '+')
        ++at;
    const DecimalDigits number = take_decimal(at, end);
    const bool ends = number.end != nullptr && (number.end == end || is_blank(*number.end));
    if (!ends || number.count == 0 || !number.exact())
        return coordinate_text::parse_unusual(word, end, value);
    const double size = number.magnitude();
    if (std::is_same_v<T, float> && !coordinate_text::rounds_once_more(size))
        return coordinate_text::parse_unusual(word, end, value);
    value = static_cast<T>(negative ? -size : size);
    return number.end;
}

/// Returns a text that describes what is expected instead of a word that is not a number.
[[nodiscard]] std::string_view expected_instead(std::string_view word) noexcept;

} // namespace lamella
