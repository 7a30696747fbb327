#include "container/json_text.hpp"

#include "lamella/core/error.hpp"

#include "container/parse_number.hpp"
#include "container/text_position.hpp"
#include "container/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lamella {

namespace {

constexpr int deepest = 64;

/// Longer strings are read to their end, but not kept: the file determines their length, and no reader needs
/// more of a key or a label.
constexpr std::size_t longest_kept = std::size_t{1} << 16;

} // namespace

void JsonText::fail(const std::string& found, const std::string& expected) const {
    throw Error(ErrorKind::input,
                fmt::format("{}, line {}: found {}; {}", name_, line_at(text_, at_), found, expected));
}

std::string JsonText::here() const {
    if (at_ >= text_.size())
        return "the end of the file";
    const std::string_view rest = text_.substr(at_, 24);
    return fmt::format("'{}'", printable(rest.substr(0, rest.find_first_of("\r\n")), 24));
}

void JsonText::skip_blanks() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t' || text_[at_] == '\r'))
        ++at_;
}

bool JsonText::is_next(char c) {
    skip_blanks();
    return at_ < text_.size() && text_[at_] == c;
}

void JsonText::open(char bracket) {
    if (!is_next(bracket))
        fail(here(), bracket == '{' ? "an object is expected" : "an array is expected");
    if (++depth_ > deepest)
        fail(fmt::format("values nested deeper than {}", deepest), "no slice file is");
    ++at_;
}

void JsonText::expect(char c) {
    if (!is_next(c))
        fail(here(), fmt::format("'{}' is expected", c));
    ++at_;
}

bool JsonText::closes(char bracket, bool first) {
    if (is_next(bracket)) {
        ++at_;
        --depth_;
        return true;
    }
    if (!first)
        expect(',');
    return false;
}

bool JsonText::next_element() {
    if (is_next(']'))
        return false;
    expect(',');
    skip_blanks();
    return true;
}

unsigned JsonText::hex4() {
    unsigned value = 0;
    const std::string_view digits = text_.substr(std::min(at_, text_.size()), 4);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc() || end != digits.data() + 4)
        fail(here(), "four hexadecimal digits must follow \\u");
    at_ += 4;
    return value;
}

void JsonText::append_escaped(std::string& to) {
    constexpr std::string_view letters = "\"\\/bfnrt";
    constexpr std::string_view meanings = "\"\\/\b\f\n\r\t";
    const char c = at_ < text_.size() ? text_[at_] : '\0';
    if (const std::size_t i = letters.find(c); c != '\0' && i != std::string_view::npos) {
        to += meanings[i];
        ++at_;
        return;
    }
    if (c != 'u')
        fail(here(), "no such escape sequence exists");
    ++at_;
    unsigned code = hex4();
    if (code >= 0xD800 && code < 0xDC00 && text_.substr(at_).starts_with("\\u")) {
        at_ += 2;
        const unsigned low = hex4();
        if (low < 0xDC00 || low > 0xDFFF)
            fail("half a surrogate pair", "its other half must follow");
        code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
    } else if (code >= 0xD800 && code < 0xE000) {
        fail("half a surrogate pair", "its other half must follow");
    }
    append_utf8(to, code);
}

std::string JsonText::string() {
    if (!is_next('"'))
        fail(here(), "a string is expected");
    ++at_;
    std::string value;
    for (;;) {
        if (at_ >= text_.size())
            fail("the end of the file within a string", "it must end with a quotation mark");
        const char c = text_[at_];
        if (static_cast<unsigned char>(c) < 0x20)
            fail("a control character in a string", "it must be escaped");
        ++at_;
        if (c == '"')
            return value;
        const std::size_t kept = value.size();
        if (c == '\\')
            append_escaped(value);
        else
            value += c;
        if (kept >= longest_kept)
            value.resize(kept);
    }
}

double JsonText::number() {
    skip_blanks();
    const char* const from = text_.data() + at_;
    const char* const end = text_.data() + text_.size();
    double value = 0;
    const char first = from == end ? '\0' : *from;
    const bool begins = first == '-' || (first >= '0' && first <= '9'); // neither "inf" nor "nan"
    const char* const to = parse_number(from, end, value);
    if (!begins || to == from || !std::isfinite(value))
        fail(here(), "a number is expected");
    at_ += static_cast<std::size_t>(to - from);
    return value;
}

void JsonText::skip() {
    if (is_next('{')) {
        object([&](const std::string&) { skip(); });
    } else if (is_next('[')) {
        array([&] { skip(); });
    } else if (is_next('"')) {
        static_cast<void>(string());
    } else {
        for (const std::string_view word : {"true", "false", "null"}) {
            if (text_.substr(at_).starts_with(word)) {
                at_ += word.size();
                return;
            }
        }
        static_cast<void>(number());
    }
}

void JsonText::end() {
    skip_blanks();
    if (at_ < text_.size())
        fail(here(), "the file must end here");
}

} // namespace lamella
