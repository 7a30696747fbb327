#pragma once

// Sequences of small empty elements, such as <vertex x="1" y="2" z="3"/>: a subset of XML that needs no
// parser. Everything accepted here is well-formed, and a parser would read it in the same way.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// A cursor over a sequence of tags with blanks between them. The byte after the sequence can be read and is
/// '<'.
class PlainTags {
  public:
    explicit PlainTags(std::string_view run) : at_(run.data()), end_(run.data() + run.size()) {}

    [[nodiscard]] const char* end() const noexcept { return end_; }

    /// Takes this tag, or this beginning of a tag, if it is next.
    bool take(std::string_view tag) {
        const char* const at = next();
        return static_cast<std::size_t>(end_ - at) >= tag.size() &&
               std::memcmp(at, tag.data(), tag.size()) == 0 && move(at + tag.size());
    }

    /// Returns whether only blanks are left.
    bool done() { return next() == end_; }

    /// Skips blanks and returns the position.
    const char* next() {
        while (is_blank(*at_))
            ++at_;
        return at_;
    }

  protected:
    static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

    /// Moves to this position; returns false if it is null.
    bool move(const char* to) {
        at_ = to == nullptr ? at_ : to;
        return to != nullptr;
    }

    const char* at_;

  private:
    const char* end_;
};

/// The result of reading an attribute.
struct PlainValue {
    int index = -1;            ///< index among the wanted attributes; -1 for others, which are skipped
    const char* end = nullptr; ///< end of the value; null if the value is invalid
};

/// The end of a tag: that of a whole element, or of its start tag; `none` if the tag is not plain.
enum class PlainTagEnd { none, element, start_tag };

/// A cursor over a sequence of elements.
class PlainElements : public PlainTags {
  public:
    /// `prefixes` are those that attributes may have, ascending.
    PlainElements(std::string_view run, std::span<const std::string> prefixes)
        : PlainTags(run), prefixes_(prefixes) {}

    using PlainTags::take;

    /// Reads the next element, which begins with `tag` and is empty, as take_attributes does.
    template <class Read>
    bool take(std::string_view tag, int wanted, const Read& read) {
        return PlainTags::take(tag) && take_attributes(wanted, read) == PlainTagEnd::element;
    }

    /// Reads the rest of a tag, and each of its `wanted` attributes by calling read(name, length of the name,
    /// value), which returns a PlainValue. The tag is not plain if it lacks one of these attributes.
    template <class Read>
    PlainTagEnd take_attributes(int wanted, const Read& read) {
        unsigned seen = 0;
        std::size_t others = 0;
        for (;;) {
            const char* at = at_;
            while (is_blank(*at))
                ++at;
            const bool is_empty = *at == '/';
            if (is_empty || *at == '>') {
                at_ = at + (is_empty ? 2 : 1);
                const bool plain = at_[-1] == '>' && seen == (1U << wanted) - 1;
                return !plain ? PlainTagEnd::none : is_empty ? PlainTagEnd::element : PlainTagEnd::start_tag;
            }
            if (at == at_)
                return PlainTagEnd::none; // no blank before the attribute
            const char* const name = at;
            while (is_name(*at))
                ++at;
            const auto length = static_cast<std::size_t>(at - name);
            if (length == 0 || *at != '=' || (at[1] != '"' && at[1] != '\''))
                return PlainTagEnd::none;
            const char quote = at[1];
            const PlainValue value = read(name, length, at + 2);
            const char* stop = value.end;
            if (value.index < 0) {
                stop = is_new({name, length}, others) ? end_of_value(at + 2, quote) : nullptr;
            } else {
                if ((seen >> value.index & 1) != 0)
                    return PlainTagEnd::none;
                seen |= 1U << value.index;
            }
            if (stop == nullptr || *stop != quote)
                return PlainTagEnd::none;
            at_ = stop + 1;
        }
    }

  private:
    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

    static bool is_name(char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == ':' || c == '-' || c == '.';
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

    std::span<const std::string> prefixes_;
    std::array<std::string_view, 16> others_; ///< names of unwanted attributes in this element
};

} // namespace lamella
