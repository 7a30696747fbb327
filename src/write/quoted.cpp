#include "write/quoted.hpp"

#include "container/text_place.hpp"

#include <cstddef>

namespace lamella {

namespace {

constexpr std::size_t longest_quote = std::size_t{1} << 16;

template <class Escape>
std::string escaped(std::string_view text, const Escape& escape) {
    std::string result;
    for (const char c : printable(text, longest_quote)) {
        const std::string_view instead = escape(c);
        if (instead.empty())
            result += c;
        else
            result += instead;
    }
    return result;
}

} // namespace

std::string json_quoted(std::string_view text) {
    return '"' +
           escaped(text,
                   [](char c) -> std::string_view { return c == '"'    ? "\\\""
                                                           : c == '\\' ? "\\\\"
                                                                       : ""; }) +
           '"';
}

std::string xml_escaped(std::string_view text) {
    return escaped(text, [](char c) -> std::string_view {
        switch (c) {
        case '&':
            return "&amp;";
        case '<':
            return "&lt;";
        case '>':
            return "&gt;";
        case '"':
            return "&quot;";
        default:
            return "";
        }
    });
}

} // namespace lamella
