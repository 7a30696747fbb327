#pragma once

// ASCII lower case independent of the locale, for comparing keywords and file names.

#include <algorithm>
#include <string>
#include <string_view>

namespace lamella {

[[nodiscard]] constexpr char lower_case(char c) noexcept {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] inline std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        c = lower_case(c);
    return result;
}

/// Returns whether a text begins with a keyword, which must be in lower case.
[[nodiscard]] constexpr bool begins_with_keyword(std::string_view text, std::string_view keyword) noexcept {
    return text.size() >= keyword.size() && std::equal(keyword.begin(), keyword.end(), text.begin(),
                                                       [](char k, char c) { return lower_case(c) == k; });
}

} // namespace lamella
