#pragma once

// Conversion of numbers to and from text for people, independent of any locale.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {

/// These functions accept finite numbers in decimal notation, with or without an exponent. They throw
/// Error{usage} that quotes the text and shows an example of the expected form.
[[nodiscard]] double parse_number(std::string_view text);
[[nodiscard]] double parse_positive(std::string_view text);
[[nodiscard]] double parse_not_negative(std::string_view text);
[[nodiscard]] std::uint64_t parse_count(std::string_view text);
/// Parses a whole number in [least, most].
[[nodiscard]] std::uint32_t parse_count_within(std::string_view text, std::uint32_t least,
                                               std::uint32_t most);
/// Parses "2G", "500M", "64k" (powers of 1000), "1GiB" (powers of 1024), or a number of bytes.
[[nodiscard]] std::uint64_t parse_byte_size(std::string_view text);
/// Parse "1,2,3" or "1 2 3".
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text);
[[nodiscard]] std::array<double, 3> parse_triple(std::string_view text);
/// Parse "a:b"; either end may be omitted.
[[nodiscard]] std::pair<double, double> parse_range(std::string_view text);
[[nodiscard]] std::pair<std::uint64_t, std::uint64_t> parse_index_range(std::string_view text);
/// Parses "2/8": the second of eight; both count from 1.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_share(std::string_view text);
/// Returns the items of a list, which are separated by commas. The views are parts of `text`.
[[nodiscard]] std::vector<std::string_view> list_items(std::string_view text);

/// Returns the shortest text that reads back to the same number.
[[nodiscard]] std::string exact(double value);
/// Returns a text for people: "31.75", "115,343", "1.2e-07".
[[nodiscard]] std::string brief(double value);
/// Returns the same for a height in mm; values that differ from 0 only by rounding in single precision become
/// "0".
[[nodiscard]] std::string height(double mm);
/// Returns "102,812".
[[nodiscard]] std::string grouped(std::uint64_t value);
/// Returns "1 layer", "2 layers".
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view noun);
/// Returns "8.3 s", "12 min 05 s", "3 h 07 min".
[[nodiscard]] std::string duration(double seconds);
/// Returns "6.2 MB".
[[nodiscard]] std::string byte_size(std::uint64_t bytes);

} // namespace lamella::app
