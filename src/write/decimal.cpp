#include "write/decimal.hpp"

#include <charconv>

namespace lamella {

namespace {
// Length of the longest double without an exponent: 309 digits before the point, or 1074 after it.
constexpr std::size_t longest = 1500;
} // namespace

std::string decimal_text(double value, int most, int least) {
    std::array<char, longest> buffer{};
    const auto result =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, most);
    std::string text(buffer.data(), result.ptr);
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
    return std::to_chars(out, out + most_double_digits, value).ptr;
}

std::string shortest_text(double value) {
    std::array<char, most_double_digits> text{};
    return {text.data(), put_shortest(text.data(), value + 0.0)};
}

std::string exact_decimal_text(double value) {
    std::array<char, longest> buffer{};
    const auto result =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0, std::chars_format::fixed);
    std::string text(buffer.data(), result.ptr);
    if (text.find('.') == std::string::npos)
        text += ".0";
    return text;
}

} // namespace lamella
