#pragma once

// Reads the numbers of plain XML (see container/xml_cursor.hpp).

#include "container/decimal_text.hpp"
#include "container/xml_cursor.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lamella {

/// Upper bound on coordinates, beyond which squares and volumes would overflow.
inline constexpr double farthest_coordinate = 1e38;

/// Reads the number that begins at `text`, and returns its end, or null if there is none.
inline const char* plain_value(const char* text, const char* end, double& value) noexcept {
    const char* const to = read_decimal(text, end, value);
    return std::abs(value) <= farthest_coordinate ? to : nullptr;
}
inline const char* plain_value(const char* text, const char* end, std::uint32_t& value) noexcept {
    return read_index(text, end, value);
}

/// Reads the rest of a tag, in which the attributes `names` are numbers.
template <std::size_t count, class Values>
XmlTagEnd take_values(XmlCursor& cursor, const std::array<std::string_view, count>& names, Values& values) {
    return cursor.take_attributes(
        names, [&](std::size_t k, const char* text) { return plain_value(text, cursor.end(), values[k]); });
}

/// Takes the number that is the next text. Returns false if there is none.
template <class Value>
bool take_value(XmlCursor& cursor, Value& value) {
    return cursor.take_text([&](const char* text) { return plain_value(text, cursor.end(), value); });
}

} // namespace lamella
