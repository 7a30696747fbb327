#include "container/decimal.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace lamella {

namespace {

// Length of the longest double without an exponent: 309 digits before the point, or 1074 after it.
constexpr std::size_t longest = 1500;

/// The shortest digits that read back as a number other than 0: 0.DIGITS * 10^exponent.
struct Digits {
    std::array<char, 17> digits{};
    int count = 0;
    int exponent = 0;
};

template <class Number>
Digits shortest_digits(Number magnitude) {
    std::array<char, 32> text{};
    const char* const end = fmt::format_to(text.data(), FMT_COMPILE("{}"), magnitude);
    Digits found;
    bool behind_point = false;
    const char* at = text.data();
    for (; at != end && *at != 'e'; ++at) {
        if (*at == '.') {
            behind_point = true;
        } else if (found.count > 0 || *at != '0') {
            found.exponent += behind_point ? 0 : 1;
            if (found.count < static_cast<int>(found.digits.size()))
                found.digits[static_cast<std::size_t>(found.count++)] = *at;
        } else {
            found.exponent -= behind_point ? 1 : 0;
        }
    }
    if (at != end)
        found.exponent += std::atoi(std::string(at + 1, end).c_str());
    while (found.digits[static_cast<std::size_t>(found.count - 1)] == '0')
        --found.count;
    return found;
}

/// Writes a positive number without an exponent. A whole number beyond 2^53 has all its digits, not only the
/// shortest ones.
template <class Number>
char* put_fixed(char* out, const Digits& shortest, Number magnitude) {
    const char* const digits = shortest.digits.data();
    if (shortest.exponent > shortest.count)
        return fmt::format_to(out, FMT_COMPILE("{:.0f}"), magnitude);
    const int before = std::max(shortest.exponent, 0);
    out = before == 0 ? std::fill_n(out, 1, '0') : std::copy_n(digits, before, out);
    if (before == shortest.count)
        return out;
    *out++ = '.';
    out = std::fill_n(out, before - shortest.exponent, '0');
    return std::copy(digits + before, digits + shortest.count, out);
}

char* put_with_exponent(char* out, const Digits& shortest) {
    *out++ = shortest.digits[0];
    if (shortest.count > 1)
        *out++ = '.';
    out = std::copy(shortest.digits.data() + 1, shortest.digits.data() + shortest.count, out);
    const int exponent = shortest.exponent - 1;
    return fmt::format_to(out, FMT_COMPILE("e{}{:02}"), exponent < 0 ? '-' : '+', std::abs(exponent));
}

/// Writes the sign, and returns the rest of the number.
template <class Number>
Number put_sign(char*& out, Number value) {
    if (!std::signbit(value))
        return value;
    *out++ = '-';
    return -value;
}

int length_without_exponent(const Digits& shortest) {
    if (shortest.exponent <= 0)
        return 2 - shortest.exponent + shortest.count;
    return shortest.exponent >= shortest.count ? shortest.exponent : shortest.count + 1;
}

int length_with_exponent(const Digits& shortest) {
    const int exponent = std::abs(shortest.exponent - 1);
    return shortest.count + (shortest.count > 1 ? 1 : 0) + (exponent < 100 ? 4 : 5);
}

template <class Number>
char* put_without_library(char* out, Number value, bool exponents) {
    const Number magnitude = put_sign(out, value);
    if (magnitude == 0 || !std::isfinite(magnitude))
        return fmt::format_to(out, FMT_COMPILE("{}"), magnitude);
    const Digits shortest = shortest_digits(magnitude);
    if (exponents && length_with_exponent(shortest) < length_without_exponent(shortest))
        return put_with_exponent(out, shortest);
    return put_fixed(out, shortest, magnitude);
}

template <class Number>
char* put(char* out, Number value, bool exponents) {
    char* const end = out + (exponents ? most_double_digits : longest);
    if constexpr (requires { std::to_chars(out, end, value, std::chars_format::fixed).ptr; })
        return exponents ? std::to_chars(out, end, value).ptr
                         : std::to_chars(out, end, value, std::chars_format::fixed).ptr;
    else
        return put_without_library(out, value, exponents);
}

} // namespace

namespace detail {

char* put_shortest_without_library(char* out, double value, bool exponents) {
    return put_without_library(out, value, exponents);
}

char* put_shortest_without_library(char* out, float value, bool exponents) {
    return put_without_library(out, value, exponents);
}

} // namespace detail

std::string decimal_text(double value, int most, int least) {
    std::string text = fmt::format("{:.{}f}", value, most);
    if (most > 0) {
        const std::size_t shortest = text.size() - static_cast<std::size_t>(most - least);
        while (text.size() > shortest && text.back() == '0')
            text.pop_back();
        if (text.back() == '.')
            text.pop_back();
    }
    if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos)
        text.erase(0, 1);
    return text;
}

char* put_shortest(char* out, double value) noexcept {
    return put(out, value, true);
}

char* put_shortest(char* out, float value) noexcept {
    return put(out, value, true);
}

std::string shortest_text(double value) {
    std::array<char, most_double_digits> text{};
    return {text.data(), put_shortest(text.data(), value + 0.0)};
}

std::string exact_decimal_text(double value) {
    std::array<char, longest> buffer{};
    std::string text(buffer.data(), put(buffer.data(), value + 0.0, false));
    if (text.find('.') == std::string::npos)
        text += ".0";
    return text;
}

} // namespace lamella
