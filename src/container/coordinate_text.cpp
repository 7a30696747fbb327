#include "container/coordinate_text.hpp"

#include "container/parse_number.hpp"
#include "core/lower_case.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace lamella {

namespace {

/// Reads a number whose exponent follows a D, as programs in Fortran write: "1.5D-3".
template <class T>
bool parse_fortran(std::string_view digits, T& value) {
    std::array<char, 64> text{};
    const std::size_t letter = digits.find_first_of("dD");
    if (letter == std::string_view::npos || digits.size() > text.size())
        return false;
    std::copy(digits.begin(), digits.end(), text.begin());
    text[letter] = 'e';
    const char* const end = text.data() + digits.size();
    return parse_number(text.data(), end, value) == end;
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
    if (parse_number(digits.data(), stop, value) != stop && !parse_fortran(digits, value))
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
