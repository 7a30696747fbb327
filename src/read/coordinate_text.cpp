#include "read/coordinate_text.hpp"

#include "core/lower_case.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

namespace lamella {

namespace {

/// Whether a number that no T can hold is too large rather than too small, from the place of its first digit
/// that is not 0.
bool is_huge(std::string_view number) {
    const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
    const std::string_view mantissa = number.substr(0, exponent_at);
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const std::size_t leading = std::min(mantissa.find_first_not_of("0."), mantissa.size());
    const auto place = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(leading);
    const std::string_view exponent = number.substr(std::min(exponent_at + 1, number.size()));
    const bool negative = exponent.starts_with('-');
    const std::string_view digits = exponent.substr(negative || exponent.starts_with('+') ? 1 : 0);
    std::int64_t power = 0;
    if (!digits.empty() &&
        std::from_chars(digits.data(), digits.data() + digits.size(), power).ec != std::errc())
        power = std::numeric_limits<std::int64_t>::max() / 2;
    return place + (negative ? -power : power) > 0;
}

template <class T>
const char* parse(const char* at, const char* end, T& value) {
    const std::string_view word = word_at(at, end);
    const std::string_view digits = word.substr(word[0] == '+' || word[0] == '-' ? 1 : 0);
    const T sign = word[0] == '-' ? T{-1} : T{1};
    const char* const stop = word.data() + word.size();
    if (begins_with_keyword(digits, "nan") || begins_with_keyword(digits, "inf") ||
        digits.starts_with("1.#")) {
        value = std::numeric_limits<T>::quiet_NaN();
        return stop;
    }
    if (digits.empty() || digits[0] == '-')
        return nullptr;
    const auto [last, code] = std::from_chars(digits.data(), stop, value);
    if (last != stop)
        return nullptr;
    if (code == std::errc::result_out_of_range)
        value = is_huge(digits) ? std::numeric_limits<T>::infinity() : T{0};
    else if (code != std::errc())
        return nullptr;
    value *= sign;
    return stop;
}

} // namespace

namespace coordinate_text {

const char* parse_unusual(const char* at, const char* end, double& value) noexcept {
    return parse(at, end, value);
}

const char* parse_unusual(const char* at, const char* end, float& value) noexcept {
    return parse(at, end, value);
}

} // namespace coordinate_text

std::string_view expected_instead(std::string_view word) noexcept {
    return word.find(',') == std::string_view::npos ? "a number"
                                                    : "a number with a decimal point and no comma";
}

} // namespace lamella
