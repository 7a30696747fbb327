#include "read/stl.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "read/stl_ascii.hpp"
#include "read/stl_binary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace lamella {

namespace {

using namespace std::string_view_literals;

struct Foreign {
    std::string_view first_bytes; ///< letters in lower case stand for both cases
    std::string_view advice;
};

/// What is often found under the name of an STL file.
constexpr std::array foreign_files = {
    Foreign{"\x1f\x8b"sv, "is compressed with gzip; unpack it first"},
    Foreign{"pk\x03\x04"sv,
            "is a zip archive (3MF files are, too); unpack it, or give it its real extension"},
    Foreign{"<!doctype html"sv, "is a web page, not an STL file; download the file itself"},
    Foreign{"<html"sv, "is a web page, not an STL file; download the file itself"},
    Foreign{"<?xml"sv, "is an XML file, not an STL file"},
    Foreign{"<amf"sv, "is an AMF file, not an STL file"},
    Foreign{"version https://git-lfs"sv,
            "is a pointer of Git LFS to the real file; fetch it with 'git lfs pull'"},
    Foreign{"\xff\xfe"sv, "is text in UTF-16; save it as UTF-8, or as binary STL"},
    Foreign{"\xfe\xff"sv, "is text in UTF-16; save it as UTF-8, or as binary STL"},
};

bool begins_with(std::string_view text, std::string_view first_bytes) {
    const auto same = [](char byte, char expected) {
        return byte == expected ||
               (expected >= 'a' && expected <= 'z' && byte == static_cast<char>(expected - ('a' - 'A')));
    };
    return text.size() >= first_bytes.size() &&
           std::equal(first_bytes.begin(), first_bytes.end(), text.begin(),
                      [&](char expected, char byte) { return same(byte, expected); });
}

/// What stands after a byte order mark and blanks.
std::string_view content(std::string_view text) {
    if (begins_with(text, "\xEF\xBB\xBF"))
        text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n\v\f");
    return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

/// Binary STL has control characters everywhere: in its numbers, and two in each attribute word.
bool looks_like_text(std::string_view text) {
    constexpr std::size_t enough = 4096;
    text = text.substr(0, enough);
    return std::none_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte == 0x7F || (byte < 0x20 && !(byte >= '\t' && byte <= '\r'));
    });
}

} // namespace

MeshFile read_stl(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    const std::uint64_t size = source.bytes.size();
    if (size >= stl_head_bytes &&
        size == stl_head_bytes + std::uint64_t{stl_record_bytes} * stl_declared_count(source.bytes))
        return read_stl_binary(source, options, execution);

    const std::string_view text(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
    if (is_stl_ascii(text))
        return read_stl_ascii(source, options, execution);

    const auto fail = [&](std::string_view what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", source.name, what));
    };
    const std::string_view begin = content(text);
    for (const Foreign& foreign : foreign_files)
        if (begins_with(text, foreign.first_bytes) || begins_with(begin, foreign.first_bytes))
            fail(foreign.advice);
    if (looks_like_text(text)) {
        if (begins_with_solid(text))
            return read_stl_ascii(source, options, execution); // it names the line where it goes wrong
        const std::string_view line = begin.substr(0, begin.find_first_of("\r\n"));
        fail(fmt::format("line {}: is a text, but not an STL file: found '{}', expected 'solid'",
                         line_at(text, text.size() - begin.size()), printable(line, 40)));
    }
    if (size < stl_head_bytes)
        fail(fmt::format(
            "is not an STL file, or cut off: found {} bytes, expected at least {} (binary) or the "
            "word 'solid' (ASCII)",
            size, stl_head_bytes));
    return read_stl_binary(source, options, execution);
}

} // namespace lamella
