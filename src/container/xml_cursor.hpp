#pragma once

// Scans plain XML: tags whose attributes are printable ASCII without references, with only blanks between the
// tags. Everything accepted here is well-formed, and a parser would read it in the same way. Where the text
// is not plain, `scan` puts the cursor back before the tag, and the parser continues there (see
// XmlHandlers::skim). Callers of the other functions must do this themselves.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The way in which a tag ends: `element` by "/>", `start_tag` by ">"; `none` if the tag is not plain.
enum class XmlTagEnd { none, element, start_tag };

/// Returns whether short names are equal. A call of memcmp would take most of the time.
[[nodiscard]] constexpr bool same_name(std::string_view a, std::string_view b) noexcept {
    if (a.size() != b.size())
        return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i])
            return false;
    return true;
}

class XmlCursor {
  public:
    /// Scans `text` from `begin` to `end`, where a '<' is. `prefixes` are those that attributes may have,
    /// ascending; they must outlive the cursor.
    XmlCursor(std::string_view text, std::size_t begin, std::size_t end,
              std::span<const std::string> prefixes = {})
        : text_(text), at_(text.data() + begin), end_(text.data() + end), prefixes_(prefixes) {
        assert(begin <= end && end < text.size() && *end_ == '<');
    }

    [[nodiscard]] std::string_view text() const noexcept { return text_; }
    [[nodiscard]] std::size_t position() const noexcept {
        return static_cast<std::size_t>(at_ - text_.data());
    }
    [[nodiscard]] const char* end() const noexcept { return end_; }
    [[nodiscard]] std::span<const std::string> prefixes() const noexcept { return prefixes_; }

    /// Moves to a position, which other cursors have reached. `lines` is the number of line ends
    /// between the position where the cursor began and this one, if it is known.
    void move_to(std::size_t position, std::optional<std::uint64_t> lines = {}) noexcept {
        at_ = text_.data() + position;
        lines_ = lines;
    }
    [[nodiscard]] std::optional<std::uint64_t> lines() const noexcept { return lines_; }

    /// Returns the names of the elements that scan() has entered, the outermost first.
    [[nodiscard]] const std::vector<std::string_view>& open() const noexcept { return open_; }

    /// Skips blanks and returns the position.
    const char* next() {
        while (is_blank(*at_))
            ++at_;
        return at_;
    }

    /// Takes this tag, or this beginning of a tag, if it is next.
    bool take(std::string_view tag) {
        next();
        return take_here(tag);
    }

    /// Takes the text that `read` reads: read(begin) returns its end, or null.
    template <class Read>
    bool take_text(const Read& read) {
        const char* const to = read(next());
        at_ = to == nullptr ? at_ : to;
        return to != nullptr;
    }

    /// Reads the rest of a tag with the attributes `names`, and perhaps others, by calling read(k, value) for
    /// the attribute names[k], which returns the end of the value, or null. The tag is not plain if it lacks
    /// one of them.
    template <std::size_t count, class Read>
    XmlTagEnd take_attributes(const std::array<std::string_view, count>& names, const Read& read) {
        if (const XmlTagEnd end = take_usual_attributes(names, read); end != XmlTagEnd::none)
            return end;
        unsigned seen = 0;
        std::size_t others = 0;
        for (;;) {
            const char* at = at_;
            while (is_blank(*at))
                ++at;
            const bool is_empty = *at == '/';
            if (is_empty || *at == '>') {
                at_ = at + (is_empty ? 2 : 1);
                const bool plain = at_[-1] == '>' && seen == (1U << count) - 1;
                return !plain ? XmlTagEnd::none : is_empty ? XmlTagEnd::element : XmlTagEnd::start_tag;
            }
            if (at == at_)
                return XmlTagEnd::none; // no blank before the attribute
            const char* const begin = at;
            while (is_name(*at))
                ++at;
            const std::string_view name(begin, static_cast<std::size_t>(at - begin));
            if (name.empty() || *at != '=' || (at[1] != '"' && at[1] != '\''))
                return XmlTagEnd::none;
            const char quote = at[1];
            std::size_t k = 0;
            while (k < count && !same_name(name, names[k]))
                ++k;
            if (k < count ? (seen >> k & 1) != 0 : !is_new(name, others))
                return XmlTagEnd::none;
            seen |= k < count ? 1U << k : 0;
            const char* const stop = k < count ? read(k, at + 2) : end_of_value(at + 2, quote);
            if (stop == nullptr || *stop != quote)
                return XmlTagEnd::none;
            at_ = stop + 1;
        }
    }

    /// Reads elements up to the first tag that is not plain, the first element at or after `limit`, or the
    /// end of their parent. start(name, position of the tag) is called behind the name, and reads the rest of
    /// the tag by take_attributes, whose result it returns; if that is `none`, it must not have changed
    /// anything.
    template <class Start, class End>
    void scan(std::size_t limit, const Start& start, const End& end) {
        while (next() != end_ && (!open_.empty() || position() < limit)) {
            const char* const tag = at_;
            if (tag[0] == '<' && tag[1] == '/' && !open_.empty()) {
                const std::string_view name = open_.back();
                at_ = tag + 2;
                if (!take_here(name) || !take(">")) {
                    at_ = tag;
                    return;
                }
                open_.pop_back();
                end(name);
                continue;
            }
            if (tag[0] != '<' || !is_letter(tag[1]) || open_.size() == most_open)
                return;
            while (is_name(*++at_))
                continue;
            const std::string_view name(tag + 1, static_cast<std::size_t>(at_ - tag) - 1);
            const XmlTagEnd tag_end = start(name, static_cast<std::size_t>(tag - text_.data()));
            if (tag_end == XmlTagEnd::none) {
                at_ = tag;
                return;
            }
            if (tag_end == XmlTagEnd::element)
                end(name);
            else
                open_.push_back(name);
        }
    }

  private:
    /// Reads a tag with the attributes `names` alone, in this order, in the usual form. This takes half the
    /// time of the general loop. Stays where it is if the tag is not of this form.
    template <std::size_t count, class Read>
    XmlTagEnd take_usual_attributes(const std::array<std::string_view, count>& names, const Read& read) {
        const char* at = at_;
        for (std::size_t k = 0; k < count; ++k) {
            if (*at++ != ' ')
                return XmlTagEnd::none;
            for (const char c : names[k])
                if (*at++ != c)
                    return XmlTagEnd::none;
            if (at[0] != '=' || at[1] != '"')
                return XmlTagEnd::none;
            at = read(k, at + 2);
            if (at == nullptr || *at++ != '"')
                return XmlTagEnd::none;
        }
        at += *at == ' ' ? 1 : 0;
        const bool is_empty = *at == '/';
        at += is_empty ? 1 : 0;
        if (*at != '>')
            return XmlTagEnd::none;
        at_ = at + 1;
        return is_empty ? XmlTagEnd::element : XmlTagEnd::start_tag;
    }

    static constexpr std::size_t most_open = 16; ///< the parser knows how deep elements may be nested

    static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

    static constexpr std::array<bool, 256> in_names = [] {
        std::array<bool, 256> is{};
        for (const char c :
             std::string_view("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_:-."))
            is[static_cast<unsigned char>(c)] = true;
        return is;
    }();
    static bool is_name(char c) { return in_names[static_cast<unsigned char>(c)]; }

    bool take_here(std::string_view text) {
        if (static_cast<std::size_t>(end_ - at_) < text.size() ||
            std::memcmp(at_, text.data(), text.size()) != 0)
            return false;
        at_ += text.size();
        return true;
    }

    /// Returns whether the name is permitted for an unwanted attribute and new in the element, and stores it.
    bool is_new(std::string_view name, std::size_t& others) {
        if (!is_letter(name.front()) || name.starts_with("xmlns") || others == others_.size())
            return false;
        if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) {
            const std::string_view local = name.substr(colon + 1);
            if (local.empty() || !is_letter(local.front()) || local.find(':') != std::string_view::npos ||
                !std::binary_search(prefixes_.begin(), prefixes_.end(), name.substr(0, colon)))
                return false;
        }
        const auto last = others_.begin() + static_cast<std::ptrdiff_t>(others);
        if (std::find(others_.begin(), last, name) != last)
            return false;
        others_[others++] = name;
        return true;
    }

    /// Returns the quote that ends a value of printable ASCII without references.
    static const char* end_of_value(const char* at, char quote) {
        for (; *at != quote; ++at)
            if (*at == '<' || *at == '&' || *at < ' ' || *at > '~') // char is signed on some processors only
                return nullptr;
        return at;
    }

    std::string_view text_;
    const char* at_;
    const char* end_;
    std::optional<std::uint64_t> lines_;
    std::vector<std::string_view> open_;
    std::span<const std::string> prefixes_;
    std::array<std::string_view, 16> others_; ///< names of unwanted attributes in this element
};

} // namespace lamella
