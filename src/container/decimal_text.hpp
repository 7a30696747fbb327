#pragma once

// Reads decimal numbers quickly, because most bytes of a mesh in a text file are digits.

#include "container/parse_number.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lamella {

/// A number as written: mantissa * 10^exponent.
struct DecimalDigits {
    std::uint64_t mantissa = 0; ///< wrapped around if there are more than 19 digits
    std::int64_t exponent = 0;
    std::ptrdiff_t count = 0;  ///< number of digits of the mantissa
    const char* end = nullptr; ///< end of the number; null if its exponent has no digits

    /// Returns whether `magnitude` is correctly rounded, because mantissa and power of ten are exact doubles,
    /// so that their quotient or product is rounded once. This holds for most numbers of mesh files.
    [[nodiscard]] bool exact() const noexcept {
        constexpr std::ptrdiff_t most_digits = 19;
        constexpr std::int64_t last_power = 22;
        return count <= most_digits && mantissa <= std::uint64_t{1} << 53 && exponent >= -last_power &&
               exponent <= last_power;
    }
    [[nodiscard]] double magnitude() const noexcept {
        constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
        const auto whole = static_cast<double>(mantissa);
        return exponent < 0 ? whole / powers[-exponent] : whole * powers[exponent];
    }
};

/// Takes the digits, the point and the exponent of a number after its sign.
inline DecimalDigits take_decimal(const char* at, const char* end) noexcept {
    DecimalDigits number;
    const auto take_digits = [&] {
        for (; at != end && static_cast<unsigned char>(*at - '0') < 10; ++at)
            number.mantissa = 10 * number.mantissa + static_cast<unsigned char>(*at - '0');
    };
    const char* const digits = at;
    take_digits();
    number.count = at - digits;
    if (at != end && *at == '.') {
        const char* const fraction = ++at;
        take_digits();
        number.exponent = fraction - at;
        number.count += at - fraction;
    }
    if (at != end && (*at == 'e' || *at == 'E')) {
        ++at;
        const bool negative = at != end && *at == '-';
        if (negative || (at != end && *at == '+'))
            ++at;
        const char* const power_digits = at;
        std::int64_t power = 0;
        constexpr std::int64_t enough = 1'000'000'000'000;
        for (; at != end && static_cast<unsigned char>(*at - '0') < 10; ++at)
            if (power < enough)
                power = 10 * power + (*at - '0');
        number.exponent += negative ? -power : power;
        if (at == power_digits)
            return number;
    }
    number.end = at;
    return number;
}

/// Reads the decimal number that begins at `first`: a sign, digits, a point, an exponent, independent of the
/// locale. It is rounded correctly; numbers too small for a double give 0, and -0 gives +0. Returns the end
/// of the number, or null if there is no number (NaN and infinity do not count) or if it is too large for a
/// double.
inline const char* read_decimal(const char* first, const char* end, double& value) noexcept {
    const bool negative = first != end && *first == '-';
    const bool signed_number = negative || (first != end && *first == '+');
    const char* const digits = first + (signed_number ? 1 : 0);
    const DecimalDigits number = take_decimal(digits, end);
    if (number.count == 0 || number.end == nullptr)
        return nullptr;
    if (number.exact()) {
        const double size = number.magnitude();
        value = negative ? 0.0 - size : size;
        return number.end;
    }
    parse_number(digits, number.end, value);
    if (std::isinf(value))
        return nullptr;
    value = negative ? 0.0 - value : value;
    return number.end;
}

/// Reads the digits that begin at `first` as an index. Returns their end, or null if there are none or the
/// number needs more than 32 bits.
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
