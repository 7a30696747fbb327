#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "read/mesh_readers.hpp"
#include "read/stl_ascii.hpp"
#include "read/stl_binary.hpp"
#include "read/text_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace lamella {

namespace {

/// Binary STL has control characters everywhere: in its numbers, and two in each attribute word.
bool looks_like_text(std::string_view text) {
    constexpr std::size_t enough = 4096;
    text = text.substr(0, enough);
    return std::none_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte == 0x7F || (byte < 0x20 && !(byte >= '\t' && byte <= '\r'));
    });
}

bool has_stl_size(const ByteSource& source) {
    const std::uint64_t size = source.bytes.size();
    return size >= stl_head_bytes &&
           size == stl_head_bytes + std::uint64_t{stl_record_bytes} * stl_declared_count(source.bytes);
}

/// Whether most corners could be those of a part. Of bytes that mean something else, such as packed ones,
/// most are not: a float can be as large as 3e38, and as small as 1e-38.
bool has_likely_corners(std::span<const std::byte> bytes) {
    constexpr std::size_t enough = 1000;      // triangles
    constexpr std::size_t corners_begin = 12; // behind the normal
    const std::size_t count = std::min((bytes.size() - stl_head_bytes) / stl_record_bytes, enough);
    std::size_t likely = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 9> corners{};
        std::memcpy(corners.data(), bytes.data() + stl_head_bytes + i * stl_record_bytes + corners_begin,
                    sizeof corners);
        likely += static_cast<std::size_t>(std::count_if(corners.begin(), corners.end(), [](float value) {
            const float size = std::abs(value);
            return size == 0 || (size > 1e-20F && size < 1e9F);
        }));
    }
    return 2 * likely >= 9 * count;
}

/// Whether it is of the binary form, else of the ASCII one. Throws Error{input} when it is neither.
bool is_binary(const ByteSource& source) {
    const std::uint64_t size = source.bytes.size();
    const std::string_view text = source.text();
    if (has_stl_size(source))
        return true;
    if (is_stl_ascii(text))
        return false;

    const auto fail = [&](std::string_view what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", source.name, what));
    };
    const std::string_view begin = after_blanks(text);
    if (looks_like_text(text)) {
        if (begins_with_solid(text))
            return false; // its reader names the line where it goes wrong
        const std::string_view line = begin.substr(0, begin.find_first_of("\r\n"));
        fail(fmt::format("line {}: is a text, but no mesh file: found '{}', expected 'solid' of an "
                         "ASCII STL file, or the beginning of another mesh format",
                         line_at(text, text.size() - begin.size()), printable(line, 40)));
    }
    if (size < stl_head_bytes)
        fail(fmt::format(
            "is not an STL file, or cut off: found {} bytes, expected at least {} (binary) or the "
            "word 'solid' (ASCII)",
            size, stl_head_bytes));
    if (!has_likely_corners(source.bytes))
        fail(
            fmt::format("is no mesh file that is known: were it a binary STL file, its count of {} would not "
                        "fit its {} bytes, and most corners would be beyond any part",
                        stl_declared_count(source.bytes), size));
    return true;
}

} // namespace

bool is_stl(const ByteSource& source) {
    return has_stl_size(source) || is_stl_ascii(source.text());
}

MeshFile read_stl(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    return is_binary(source) ? read_stl_binary(source, options, execution)
                             : read_stl_ascii(source, options, execution);
}

std::optional<std::uint64_t> stl_records(const ByteSource& source) {
    if (!is_binary(source))
        return std::nullopt;
    return stl_extent(source.bytes.size(), stl_declared_count(source.bytes)).triangles;
}

MeshFile stream_stl(const ByteSource& source, const TriangleSink& sink, const MeshReadOptions& options,
                    const Execution& execution, const std::optional<RecordRange>& share) {
    if (is_binary(source))
        return stream_stl_binary(source, sink, options, execution, share);
    if (share)
        throw Error(ErrorKind::usage,
                    fmt::format("{}: is an ASCII STL file, which can be read as a whole only; a share of "
                                "its triangles can be read of a binary one",
                                source.name));
    return stream_stl_ascii(source, sink, options, execution);
}

} // namespace lamella
