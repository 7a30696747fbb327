#include "meshes/ply_header.hpp"

#include "lamella/core/error.hpp"

#include "container/text_chunks.hpp"
#include "container/text_position.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <string_view>

namespace lamella {

namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr std::array type_names = {
    TypeName{"char", PlyType::int8},      TypeName{"int8", PlyType::int8},
    TypeName{"uchar", PlyType::uint8},    TypeName{"uint8", PlyType::uint8},
    TypeName{"short", PlyType::int16},    TypeName{"int16", PlyType::int16},
    TypeName{"ushort", PlyType::uint16},  TypeName{"uint16", PlyType::uint16},
    TypeName{"int", PlyType::int32},      TypeName{"int32", PlyType::int32},
    TypeName{"uint", PlyType::uint32},    TypeName{"uint32", PlyType::uint32},
    TypeName{"int64", PlyType::int64},    TypeName{"uint64", PlyType::uint64},
    TypeName{"float", PlyType::float32},  TypeName{"float32", PlyType::float32},
    TypeName{"double", PlyType::float64}, TypeName{"float64", PlyType::float64},
};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    Words at(line, 0);
    for (at.skip_blanks(); !at.at_end(); at.skip_blanks()) {
        words.push_back(at.peek());
        at.skip_word();
    }
    return words;
}

/// Reads the lines of a header.
class HeaderReader {
  public:
    HeaderReader(const ByteSource& source, Remarks& remarks)
        : source_(source), remarks_(remarks), text_(source.text()), at_(after_byte_order_mark(text_)) {}

    PlyHeader run() {
        next_line();
        const std::size_t first_end = text_.find_first_of("\r\n");
        if (words_.size() != 1 || words_[0] != "ply")
            fail("the line 'ply'");
        if (first_end != std::string_view::npos && text_[first_end] == '\r')
            line_end_ = text_.substr(first_end, 2) == "\r\n" ? 2 : 1;
        bool has_form = false;
        for (;;) {
            if (!next_line())
                fail("'end_header'");
            const std::string_view keyword = words_.empty() ? std::string_view() : words_[0];
            if (keyword == "end_header")
                break;
            if (keyword == "format") {
                read_form();
                has_form = true;
            } else if (keyword == "element") {
                read_element();
            } else if (keyword == "property") {
                read_property();
            } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
                remarks_.add(fmt::format("line {}: took '{}' in the header for a comment", line_number_,
                                         printable(line_, 40)));
            }
        }
        if (!has_form) {
            words_.clear();
            fail("a line 'format' before this one");
        }
        assert(at_ <= text_.size());
        header_.end = at_;
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(std::string_view expected) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}: line {}: found '{}' in the header of a PLY file, expected {}",
                                source_.name, line_number_, printable(line_, 40), expected));
    }

    /// Reads the next line. Lines end like the first one, except that some programs write LF but end the
    /// header with CRLF. Binary rows begin immediately after the header, possibly with a byte that looks like
    /// a line end.
    bool next_line() {
        if (at_ == text_.size()) {
            line_ = {};
            words_.clear();
            return false;
        }
        constexpr std::size_t longest_line = 100'000;
        const std::size_t stop = std::min(text_.find_first_of("\r\n", at_), text_.size());
        line_ = text_.substr(at_, stop - at_);
        ++line_number_;
        if (line_.size() > longest_line)
            fail("shorter lines");
        words_ = words_of(line_);
        at_ = stop;
        if (text_.substr(at_, 2) == "\r\n")
            at_ += line_end_ == 1 ? 1 : 2;
        else if (at_ != text_.size())
            ++at_;
        return true;
    }

    void read_form() {
        constexpr std::string_view expected =
            "'ascii', 'binary_little_endian' or 'binary_big_endian', and version 1.0";
        if (words_.size() < 3 || words_[2] != "1.0")
            fail(expected);
        if (words_[1] == "ascii")
            header_.form = PlyForm::ascii;
        else if (words_[1] == "binary_little_endian")
            header_.form = PlyForm::little_endian;
        else if (words_[1] == "binary_big_endian")
            header_.form = PlyForm::big_endian;
        else
            fail(expected);
    }

    void read_element() {
        PlyElement element;
        constexpr std::string_view expected = "the name of an element and how many there are";
        if (words_.size() < 3)
            fail(expected);
        element.name = words_[1];
        const char* const end = words_[2].data() + words_[2].size();
        const auto [stop, code] = std::from_chars(words_[2].data(), end, element.rows);
        if (stop != end || code != std::errc())
            fail(expected);
        constexpr std::size_t most_elements = 1'000;
        if (header_.elements.size() == most_elements)
            fail("fewer elements");
        header_.elements.push_back(std::move(element));
    }

    void read_property() {
        if (header_.elements.empty())
            fail("an element before its properties");
        PlyElement& element = header_.elements.back();
        constexpr std::size_t most_properties = 10'000;
        if (element.properties.size() == most_properties)
            fail("fewer properties");
        if (words_.size() >= 5 && words_[1] == "list") {
            const PlyType length = type(words_[2]);
            if (length == PlyType::float32 || length == PlyType::float64)
                fail("a whole number for the length of a list");
            element.properties.push_back({std::string(words_[4]), type(words_[3]), length});
        } else if (words_.size() >= 3 && words_[1] != "list") {
            element.properties.push_back({std::string(words_[2]), type(words_[1]), {}});
        } else {
            fail("'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        }
    }

    [[nodiscard]] PlyType type(std::string_view name) const {
        const auto* const known = std::find_if(type_names.begin(), type_names.end(),
                                               [&](const TypeName& type) { return type.name == name; });
        if (known == type_names.end())
            fail("a type such as float, uchar or int32");
        return known->type;
    }

    const ByteSource& source_;
    Remarks& remarks_;
    std::string_view text_;
    PlyHeader header_;
    std::size_t at_;
    std::uint64_t line_number_ = 0;
    std::size_t line_end_ = 0; ///< length of the first line end, if it begins with CR
    std::string_view line_;
    std::vector<std::string_view> words_;
};

} // namespace

std::size_t ply_bytes(PlyType type) noexcept {
    switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
        return 1;
    case PlyType::int16:
    case PlyType::uint16:
        return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
        return 4;
    case PlyType::int64:
    case PlyType::uint64:
    case PlyType::float64:
        return 8;
    }
    return 0;
}

std::optional<std::size_t> PlyElement::row_bytes() const {
    std::size_t sum = 0;
    for (const PlyProperty& property : properties) {
        if (property.list_length)
            return std::nullopt;
        sum += ply_bytes(property.type);
    }
    return sum;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](const PlyProperty& one) { return one.name == property; });
    if (found == properties.end())
        return std::nullopt;
    return static_cast<std::size_t>(found - properties.begin());
}

PlyHeader read_ply_header(const ByteSource& source, Remarks& remarks) {
    return HeaderReader(source, remarks).run();
}

} // namespace lamella
