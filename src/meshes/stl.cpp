#include "lamella/core/error.hpp"

#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "core/counted.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/stl_ascii.hpp"
#include "meshes/stl_attributes.hpp"
#include "meshes/stl_binary.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

namespace {

/// Returns whether there are no control characters. Binary STL contains some, in its numbers and in each
/// attribute word.
bool looks_like_text(std::string_view text) {
    constexpr std::size_t enough = 4096;
    text = text.substr(0, enough);
    return std::none_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte == 0x7F || (byte < 0x20 && !(byte >= '\t' && byte <= '\r'));
    });
}

bool has_stl_size(std::span<const std::byte> beginning, std::uint64_t size) {
    return size >= stl_header_bytes &&
           size == stl_header_bytes + std::uint64_t{stl_record_bytes} * stl_declared_count(beginning);
}

/// Returns whether most corners are plausible for a part. In data of another kind, such as compressed data,
/// most are not, because floats range from 1e-38 to 3e38.
bool has_likely_corners(std::span<const std::byte> bytes) {
    constexpr std::size_t enough = 1000; // triangles
    static_assert(stl_header_bytes + enough * stl_record_bytes <= window_beginning);
    const std::size_t count = std::min((bytes.size() - stl_header_bytes) / stl_record_bytes, enough);
    std::size_t likely = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 9> corners{};
        std::memcpy(corners.data(), bytes.data() + stl_header_bytes + i * stl_record_bytes + stl_normal_bytes,
                    sizeof corners);
        likely += static_cast<std::size_t>(std::count_if(corners.begin(), corners.end(), [](float value) {
            const float size = std::abs(value);
            return size == 0 || (size > 1e-20F && size < 1e9F);
        }));
    }
    return 2 * likely >= 9 * count;
}

/// Throws if the numbers of a file whose size fits its count cannot be those of a part: nearly all that are
/// not 0 are beyond any part, and some are extremely close to 0. Files of other programs and with other byte
/// orders have such numbers.
void refuse_implausible(const ByteSource& source) {
    constexpr std::size_t enough = 1000; // triangles
    const std::size_t count = std::min((source.bytes.size() - stl_header_bytes) / stl_record_bytes, enough);
    std::size_t likely = 0;
    std::size_t tiny = 0;
    std::size_t huge = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 9> corners{};
        std::memcpy(corners.data(),
                    source.bytes.data() + stl_header_bytes + i * stl_record_bytes + stl_normal_bytes,
                    sizeof corners);
        for (const float value : corners) {
            const float size = std::abs(value);
            if (size == 0 || !std::isfinite(size))
                continue;
            tiny += size < 1e-20F ? 1 : 0;
            huge += size > 1e20F ? 1 : 0;
            likely += size >= 1e-20F && size <= 1e20F ? 1 : 0;
        }
    }
    if (tiny != 0 && tiny + huge > likely)
        throw Error(ErrorKind::input,
                    fmt::format("{}: is no mesh file that is known: were it a binary STL file, most of its "
                                "coordinates that are not 0 would be below 1e-20 or above 1e20",
                                source.name));
}

/// Throws if the count and the size of a file agree only if its numbers are read as big-endian.
void refuse_big_endian(const ByteSource& source) {
    std::uint32_t count = stl_declared_count(source.bytes);
    count = count >> 24 | (count >> 8 & 0xFF00U) | (count << 8 & 0xFF0000U) | count << 24;
    if (count != 0 && source.size() == stl_header_bytes + std::uint64_t{stl_record_bytes} * count)
        throw Error(ErrorKind::input,
                    fmt::format("{}: is a binary STL file in big-endian byte order: its count reads {} so, "
                                "which fits its size; STL files are little-endian: write it anew with the "
                                "bytes of each number reversed",
                                source.name, count));
}

/// Returns whether the corners of a record are plausible: all numbers are finite, and none is huge or
/// extremely close to 0 but not 0.
bool is_likely(std::span<const std::byte> record) {
    std::array<float, 9> corners{};
    std::memcpy(corners.data(), record.data() + stl_normal_bytes, sizeof corners);
    return std::all_of(corners.begin(), corners.end(), [](float value) {
        const float size = std::abs(value);
        return size == 0 || (size > 1e-20F && size < 1e9F);
    });
}

/// Returns whether bytes were lost or added within the file. Then the first records are plausible and most
/// others are not, or the last ones are plausible only if counted back from the end of the file.
bool is_shifted(const ByteSource& source) {
    constexpr std::size_t few = 5; // for files that lose or gain bytes repeatedly
    constexpr std::size_t enough = 1000;
    const std::size_t stored = (source.size() - stl_header_bytes) / stl_record_bytes;
    const std::uint32_t declared = stl_declared_count(source.bytes);
    const std::size_t records = declared == 0 ? stored : std::min<std::size_t>(stored, declared);
    const auto likely = [&](std::size_t count, const auto& offset_of) {
        std::size_t found = 0;
        std::array<std::byte, stl_record_bytes> bytes{};
        for (std::size_t i = 0; i < count; ++i) {
            copy_out(source, offset_of(i), bytes);
            found += is_likely(bytes) ? 1 : 0;
        }
        return found;
    };
    const auto record = [&](std::size_t i) {
        return stl_header_bytes + i * stl_record_bytes;
    };
    const std::size_t ends = std::min(records, few);
    const std::size_t sample = std::min(records, enough);
    if (ends == 0 || likely(ends, record) < ends)
        return false;
    if (2 * likely(sample, [&](std::size_t i) { return record(i * records / sample); }) < sample)
        return true;
    const auto from_end = [&](std::size_t i) {
        return source.size() - (i + 1) * stl_record_bytes;
    };
    return likely(ends, from_end) == ends &&
           2 * likely(ends, [&](std::size_t i) { return record(records - 1 - i); }) < ends;
}

/// For a binary file whose size contradicts its count, describes damage by a transfer in text mode; "" if
/// there is none.
std::string_view text_mode_damage(const ByteSource& source) {
    constexpr std::size_t enough = std::size_t{1} << 20;
    constexpr std::size_t many = 4; // a byte has a given value by chance once in 256 times
    std::string text(std::min<std::uint64_t>(source.size(), enough), '\0');
    copy_out(source, 0, std::as_writable_bytes(std::span(text)));
    std::size_t line_feeds = 0;
    std::size_t without_return = 0;
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
        ++line_feeds;
        without_return += at == 0 || text[at - 1] != '\r' ? 1 : 0;
    }
    if (line_feeds >= many && without_return == 0)
        return "each byte 0x0A has become 0x0D 0x0A";
    std::size_t replaced = 0; // bytes replaced by U+FFFD, or encoded as two bytes
    std::size_t high = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        high += byte >= 0x80 ? 1 : 0;
        if (text.compare(i, 3, "\xEF\xBF\xBD") == 0)
            replaced += 3;
        else if ((byte == 0xC2 || byte == 0xC3) && i + 1 < text.size() &&
                 (static_cast<unsigned char>(text[i + 1]) & 0xC0U) == 0x80U)
            replaced += 2;
    }
    if (high >= many && 10 * replaced >= 9 * high)
        return "bytes from 0x80 on were taken for characters and encoded anew";
    if (is_shifted(source))
        return "bytes were added or lost in it";
    return {};
}

/// Returns true for the binary form, false for the ASCII form. Throws Error{input} if it is neither.
bool is_binary(const ByteSource& source) {
    const std::uint64_t size = source.size();
    const std::string_view text = source.text();
    if (has_stl_size(source.bytes, size)) {
        refuse_implausible(source);
        return true;
    }
    if (is_stl_ascii(text))
        return false;
    if (has_attribute_bytes(source))
        return true;

    const auto fail = [&](std::string_view what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", source.name, what));
    };
    const std::string_view begin = after_blanks(text);
    if (looks_like_text(text)) {
        if (begins_with_solid(text))
            return false; // its reader reports the line of the error
        const std::string_view line = begin.substr(0, begin.find_first_of("\r\n"));
        fail(fmt::format("line {}: is a text, but no mesh file: found '{}', expected 'solid' of an "
                         "ASCII STL file, or the beginning of another mesh format",
                         line_at(text, text.size() - begin.size()), printable(line, 40)));
    }
    if (size < stl_header_bytes)
        fail(fmt::format(
            "is not an STL file, or cut off: found {} bytes, expected at least {} (binary) or the "
            "word 'solid' (ASCII)",
            size, stl_header_bytes));
    refuse_big_endian(source);
    if (const std::string_view damage = text_mode_damage(source); !damage.empty())
        fail(fmt::format(
            "is a binary STL file that was damaged, as by a transfer or a checkout in text mode: {}; "
            "its count of {} does not fit its {} bytes; get the file again, as a binary one",
            damage, stl_declared_count(source.bytes), size));
    if (!has_likely_corners(source.bytes))
        fail(
            fmt::format("is no mesh file that is known: were it a binary STL file, its count of {} would not "
                        "fit its {} bytes, and most corners would be beyond any part",
                        stl_declared_count(source.bytes), size));
    return true;
}

} // namespace

bool is_likely_stl_binary(std::span<const std::byte> beginning, std::uint64_t size) {
    if (has_stl_size(beginning, size))
        return true;
    const std::string_view text(reinterpret_cast<const char*>(beginning.data()), beginning.size());
    return size >= stl_header_bytes && !looks_like_text(text) && has_likely_corners(beginning);
}

bool is_stl(const ByteSource& source) {
    return has_stl_size(source.bytes, source.size()) || is_stl_ascii(source.text());
}

bool can_stream_stl(const ByteSource& source) {
    return !has_attribute_bytes(source);
}

MeshFile read_stl(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    if (is_binary(source) && has_attribute_bytes(source)) {
        ReadLimits limits(source, options);
        MeshFile file = read_stl_binary(without_attribute_bytes(source, limits), options, execution);
        file.warnings.push_back(
            fmt::format("left out {} that follow triangles, as the triangles count them",
                        counted(source.size() - stl_header_bytes - file.stored_triangles * stl_record_bytes,
                                "attribute byte")));
        return file;
    }
    if (is_binary(source))
        return read_stl_binary(source, options, execution);
    return read_stl_ascii(whole(source, execution, memory_of_file(options.max_memory)), options, execution);
}

std::optional<std::uint64_t> stl_records(const ByteSource& source) {
    if (!is_binary(source))
        return std::nullopt;
    return stl_extent(source.size(), stl_declared_count(source.bytes)).triangles;
}

MeshFile stream_stl(const ByteSource& source, const TriangleSink& sink, const MeshReadOptions& options,
                    const Execution& execution, const std::optional<RecordRange>& share) {
    if (is_binary(source))
        return stream_stl_binary(source, sink, options, execution, share);
    if (share)
        throw Error(ErrorKind::usage,
                    fmt::format("{}: is an ASCII STL file, which can be read as a whole only; a part of "
                                "its triangles can be read of a binary one",
                                source.name));
    return stream_stl_ascii(whole(source, execution, memory_of_file(options.max_memory)), sink, options,
                            execution);
}

} // namespace lamella
