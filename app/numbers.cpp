#include "numbers.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <type_traits>

namespace lamella::app {
namespace {

[[noreturn]] void refuse(std::string_view found, std::string_view expected) {
    throw Error(ErrorKind::usage, fmt::format("\"{}\" is not {}", excerpt(found), expected));
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Parses all of `text` as a number. Returns whether it is one. Numbers too large for a double become
/// infinite.
template <class Number>
bool read(std::string_view text, Number& value) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        text.remove_prefix(1);
    const char* const end = text.data() + text.size();
    if constexpr (std::is_floating_point_v<Number>) {
        const auto [last, error] = fast_float::from_chars(text.data(), end, value);
        return error == std::errc() && last == end;
    } else {
        const auto [last, error] = std::from_chars(text.data(), end, value);
        return error == std::errc() && last == end;
    }
}

/// Returns the two ends of "a:b"; an omitted end keeps its value.
template <class Number>
std::pair<Number, Number> read_range(std::string_view text, std::pair<Number, Number> range,
                                     std::string_view expected) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos)
        refuse(text, expected);
    const std::string_view first = trimmed(text.substr(0, colon));
    const std::string_view second = trimmed(text.substr(colon + 1));
    if ((!first.empty() && !read(first, range.first)) || (!second.empty() && !read(second, range.second)))
        refuse(text, expected);
    return range;
}

constexpr std::string_view a_number = "a number such as 0.1";

bool read_finite(std::string_view text, double& value) {
    return read(text, value) && std::isfinite(value);
}

/// Parses "1,2,3" or "1 2 3"; `refuse_word` throws for a word that is not a number.
template <class RefuseWord>
std::vector<double> read_numbers(std::string_view text, const RefuseWord& refuse_word) {
    std::vector<double> numbers;
    std::string_view rest = trimmed(text);
    const std::string_view gaps = rest.find(',') == std::string_view::npos ? " \t" : ",";
    while (true) {
        const auto gap = rest.find_first_of(gaps);
        const std::string_view word = rest.substr(0, gap);
        if (!read_finite(word, numbers.emplace_back()))
            refuse_word(word);
        if (gap == std::string_view::npos)
            return numbers;
        rest = trimmed(rest.substr(gap + 1));
    }
}

} // namespace

double parse_number(std::string_view text) {
    double value = 0;
    if (!read_finite(text, value))
        refuse(text, a_number);
    return value;
}

double parse_positive(std::string_view text) {
    const double value = parse_number(text);
    if (!(value > 0))
        refuse(text, "a number above 0");
    return value;
}

double parse_not_negative(std::string_view text) {
    const double value = parse_number(text);
    if (!(value >= 0))
        refuse(text, "a number that is not negative");
    return value;
}

std::uint64_t parse_count(std::string_view text) {
    std::uint64_t value = 0;
    if (!read(text, value)) {
        const bool digits_only = text.find_first_not_of("0123456789") == std::string_view::npos;
        refuse(text, digits_only && !text.empty()
                         ? fmt::format("a number up to {}", std::numeric_limits<std::uint64_t>::max())
                         : "a whole number such as 4");
    }
    return value;
}

std::uint32_t parse_count_within(std::string_view text, std::uint32_t least, std::uint32_t most) {
    std::uint64_t value = 0;
    if (!read(text, value) || value < least || value > most)
        refuse(text, fmt::format("a whole number from {} to {}", least, most));
    return static_cast<std::uint32_t>(value);
}

std::uint64_t parse_byte_size(std::string_view text) {
    const auto refuse = [&] {
        throw Error(
            ErrorKind::usage,
            fmt::format("\"{}\" is no amount of memory; expected such as 2G, 500M or 1GiB", excerpt(text)));
    };
    const std::size_t digits = text.find_first_not_of("0123456789.");
    std::string_view unit = digits == std::string_view::npos ? "" : text.substr(digits);
    if (unit.size() > 1 && (unit.back() == 'B' || unit.back() == 'b'))
        unit.remove_suffix(1);
    const bool binary = unit.size() == 2 && unit[1] == 'i';
    constexpr std::string_view prefixes = "kmgt";
    std::size_t power = 0;
    if (!unit.empty()) {
        const char letter =
            unit[0] >= 'A' && unit[0] <= 'Z' ? static_cast<char>(unit[0] - 'A' + 'a') : unit[0];
        power = prefixes.find(letter) + 1;
        if (power == 0 || (unit.size() != 1 && !binary))
            refuse();
    }
    const double bytes = parse_positive(text.substr(0, digits)) *
                         std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(power));
    if (!(bytes >= 1 && bytes < 1e18))
        refuse();
    return static_cast<std::uint64_t>(bytes);
}

std::vector<std::string_view> list_items(std::string_view text) {
    std::vector<std::string_view> items;
    while (!text.empty()) {
        const std::size_t comma = text.find(',');
        items.push_back(text.substr(0, comma));
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
    return items;
}

std::vector<double> parse_numbers(std::string_view text) {
    return read_numbers(text, [](std::string_view word) { refuse(word, a_number); });
}

std::array<double, 3> parse_triple(std::string_view text) {
    constexpr std::string_view expected = "three numbers such as 1,0,0.5";
    const std::vector<double> numbers =
        read_numbers(text, [&](std::string_view /*word*/) { refuse(text, expected); });
    if (numbers.size() != 3)
        refuse(text, expected);
    return {numbers[0], numbers[1], numbers[2]};
}

std::pair<double, double> parse_range(std::string_view text) {
    constexpr std::string_view expected = "a range such as 1.5:20 (or 1.5: or :20)";
    constexpr double most = std::numeric_limits<double>::max();
    const auto range = read_range<double>(text, {-most, most}, expected);
    if (!std::isfinite(range.first) || !std::isfinite(range.second))
        refuse(text, expected);
    if (range.first > range.second)
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" is empty: its end lies below its start", excerpt(text)));
    return range;
}

std::pair<std::uint64_t, std::uint64_t> parse_index_range(std::string_view text) {
    const auto range = read_range<std::uint64_t>(text, {0, std::numeric_limits<std::uint64_t>::max()},
                                                 "a range such as 0:100 (or 10: or :100)");
    if (range.first >= range.second)
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" holds no layer: the second number is the first layer left out",
                                excerpt(text)));
    return range;
}

std::pair<std::uint32_t, std::uint32_t> parse_share(std::string_view text) {
    constexpr std::string_view expected = "a share such as 2/8, the second of eight";
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos)
        refuse(text, expected);
    const std::uint64_t number = parse_count(text.substr(0, slash));
    const std::uint64_t count = parse_count(text.substr(slash + 1));
    if (number < 1 || number > count || count > std::numeric_limits<std::uint32_t>::max())
        refuse(text, expected);
    return {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(count)};
}

std::string exact(double value) {
    return fmt::format("{}", value);
}

std::string brief(double value) {
    // Six digits, or all digits before the point.
    constexpr double long_number = 1e5;
    constexpr double longest_number = 1e15;
    if (std::abs(value) >= long_number && std::abs(value) < longest_number)
        return fmt::format("{}{}", value < 0 ? "-" : "",
                           grouped(static_cast<std::uint64_t>(std::llround(std::abs(value)))));
    return fmt::format("{:.6g}", value + 0.0);
}

std::string height(double mm) {
    constexpr double left_of_0 = 1e-7;
    return brief(std::abs(mm) < left_of_0 ? 0 : mm);
}

std::string grouped(std::uint64_t value) {
    std::string digits = std::to_string(value);
    for (std::size_t i = digits.size(); i > 3;) {
        i -= 3;
        digits.insert(i, 1, ',');
    }
    return digits;
}

std::string counted(std::uint64_t n, std::string_view noun) {
    return fmt::format("{} {}{}", grouped(n), noun, n == 1 ? "" : "s");
}

std::string duration(double seconds) {
    constexpr double minute = 60;
    constexpr double longest = 1e15; // also for files that have any number
    if (!(seconds >= minute))
        return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::uint64_t>(std::llround(std::min(seconds, longest)));
    const std::uint64_t minutes = whole / 60;
    return minutes < 60 ? fmt::format("{} min {:02} s", minutes, whole % 60)
                        : fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

std::string byte_size(std::uint64_t bytes) {
    constexpr std::array<const char*, 5> units{"bytes", "kB", "MB", "GB", "TB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 999.5 && unit + 1 < units.size()) {
        value /= 1000;
        ++unit;
    }
    return fmt::format("{:.{}f} {}", value, unit > 0 && value < 9.95 ? 1 : 0, units[unit]);
}

} // namespace lamella::app
