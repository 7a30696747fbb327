#pragma once

// Numbers in texts, quickly: most of the bytes of a mesh in a text file are digits.

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <system_error>

namespace lamella {

/// Reads the decimal number that begins at `first`: a sign, digits, a point, an exponent, whatever the
/// locale. Correctly rounded; what is too small for a double is 0, and there is no negative zero. Returns
/// where the number ends, or null when none begins here (NaN and infinity are none) or it is too large for a
/// double.
inline const char* read_decimal(const char* first, const char* end, double& value) noexcept {
    constexpr auto is_digit = [](char c) {
        return c >= '0' && c <= '9';
    };
    const char* at = first;
    const bool negative = at != end && *at == '-';
    if (negative || (at != end && *at == '+'))
        ++at;
    const char* const digits = at;
    std::uint64_t mantissa = 0; // may overflow; then it is not used
    for (; at != end && is_digit(*at); ++at)
        mantissa = 10 * mantissa + static_cast<std::uint64_t>(*at - '0');
    std::ptrdiff_t count = at - digits;
    std::int64_t exponent = 0;
    if (at != end && *at == '.') {
        const char* const fraction = ++at;
        for (; at != end && is_digit(*at); ++at)
            mantissa = 10 * mantissa + static_cast<std::uint64_t>(*at - '0');
        exponent = fraction - at;
        count += at - fraction;
    }
    if (count == 0)
        return nullptr;
    if (at != end && (*at == 'e' || *at == 'E')) {
        ++at;
        const bool negative_power = at != end && *at == '-';
        if (negative_power || (at != end && *at == '+'))
            ++at;
        if (at == end || !is_digit(*at))
            return nullptr;
        std::int64_t power = 0;
        constexpr std::int64_t enough = 1'000'000'000'000;
        for (; at != end && is_digit(*at); ++at)
            if (power < enough)
                power = 10 * power + (*at - '0');
        exponent += negative_power ? -power : power;
    }
    // Where mantissa and power of ten are exact doubles, their quotient or product is rounded once, rightly.
    constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    constexpr std::int64_t last_power = 22;
    constexpr std::ptrdiff_t most_digits = 19;
    if (count <= most_digits && mantissa <= std::uint64_t{1} << 53 && exponent >= -last_power &&
        exponent <= last_power) {
        const auto whole = static_cast<double>(mantissa);
        const double size = exponent < 0 ? whole / powers[-exponent] : whole * powers[exponent];
        value = negative ? 0.0 - size : size;
        return at;
    }
    const auto [stop, code] = std::from_chars(*first == '+' ? first + 1 : first, at, value);
    if (code == std::errc::result_out_of_range) {
        // Too large or too small? The first digit that is not 0 tells.
        const char* lead = digits;
        std::ptrdiff_t zeros = 0;
        for (; *lead == '0' || *lead == '.'; ++lead)
            zeros += *lead == '0' ? 1 : 0;
        if (exponent + (count - zeros) > 0)
            return nullptr;
        value = 0;
    }
    value += 0.0;
    return at;
}

/// Reads the digits that begin at `first` as an index. Returns where they end, or null when there are none or
/// the number needs more than 32 bits.
inline const char* read_index(const char* first, const char* end, std::uint32_t& value) noexcept {
    std::uint64_t number = 0;
    const char* at = first;
    for (; at != end && *at >= '0' && *at <= '9'; ++at) {
        number = 10 * number + static_cast<std::uint64_t>(*at - '0');
        if (number > std::numeric_limits<std::uint32_t>::max())
            return nullptr;
    }
    value = static_cast<std::uint32_t>(number);
    return at == first ? nullptr : at;
}

} // namespace lamella
