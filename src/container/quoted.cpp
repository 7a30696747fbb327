#include "container/quoted.hpp"

#include "container/text_position.hpp"

#include <algorithm>
#include <cstddef>
#include <initializer_list>

namespace lamella {

namespace {

constexpr std::size_t longest_quote = std::size_t{1} << 16;

struct Escape {
    char character;
    std::string_view text;
};

std::string escaped(std::string_view text, std::initializer_list<Escape> escapes) {
    std::string result;
    for (const char c : quotable(text)) {
        const Escape* const found = std::find_if(escapes.begin(), escapes.end(),
                                                 [&](const Escape& escape) { return escape.character == c; });
        if (found == escapes.end())
            result += c;
        else
            result += found->text;
    }
    return result;
}

} // namespace

std::string quotable(std::string_view text) {
    return printable(text, longest_quote);
}

std::string printable_label(std::string_view text) {
    constexpr std::size_t longest = 4096;
    return printable(text, longest);
}

std::string common_layer_label(std::string_view text) {
    std::string label;
    for (const char c : text) {
        const bool harmless = c >= ' ' && c <= '~' && c != '"' && c != '$' && c != ',' && c != '/';
        label += harmless ? c : '_';
    }
    return label;
}

std::string json_quoted(std::string_view text) {
    return '"' + escaped(text, {{'"', "\\\""}, {'\\', "\\\\"}}) + '"';
}

std::string page_quoted(std::string_view text) {
    return '"' + escaped(text, {{'"', "\\\""}, {'\\', "\\\\"}, {'<', "\\u003c"}}) + '"';
}

std::string xml_escaped(std::string_view text) {
    return escaped(text, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}});
}

} // namespace lamella
