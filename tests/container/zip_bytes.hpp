#pragma once

// Zip archives in memory, valid and forged: each field that a reader must check can be given a wrong value.

#include "container/deflate.hpp"
#include "container/inflate.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::zip_test {

struct ZipPart {
    std::string name;
    std::string content;
    bool deflated = true;
    bool sizes_behind = false; ///< a data descriptor follows
    bool zip64 = false;
    // Values that replace the true ones.
    std::optional<std::string> inner_name = {};
    std::optional<std::string> compressed = {};
    std::optional<std::uint64_t> size = {};
    std::optional<std::uint64_t> inner_size = {};
    std::optional<std::uint64_t> compressed_size = {};
    std::optional<std::uint64_t> position = {};
    std::optional<std::uint32_t> crc = {};
    std::optional<unsigned> method = {};
    unsigned flags = 0;
    unsigned disc = 0;
};

struct ZipEnd {
    std::string comment = {};
    bool zip64 = false;
    std::optional<std::uint64_t> entries = {};
    std::optional<std::uint64_t> directory_size = {};
    std::optional<std::uint64_t> directory_offset = {};
};

inline std::string deflated(std::string_view content) {
    std::string compressed;
    Deflater().append_chunk(content, compressed);
    compressed += deflate_end;
    return compressed;
}

inline void put(std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        out += static_cast<char>(value >> (8 * i));
}

inline std::string zip_bytes(const std::vector<ZipPart>& parts, const ZipEnd& end = {}) {
    constexpr std::uint64_t full = 0xFFFFFFFF;
    std::string file;
    std::string directory;
    for (const ZipPart& part : parts) {
        const std::string compressed =
            part.compressed.value_or(part.deflated ? deflated(part.content) : part.content);
        const std::uint64_t compressed_size = part.compressed_size.value_or(compressed.size());
        const std::uint64_t size = part.size.value_or(part.content.size());
        const std::uint64_t inner_size = part.inner_size.value_or(size);
        const std::uint32_t crc = part.crc.value_or(crc32_of(part.content));
        const unsigned method = part.method.value_or(part.deflated ? 8 : 0);
        const unsigned flags = part.flags | (part.sizes_behind ? 8U : 0U);
        const std::uint64_t position = part.position.value_or(file.size());
        const std::string inner_name = part.inner_name.value_or(part.name);
        const bool behind = part.sizes_behind;

        put(file, 0x04034b50, 4);
        put(file, part.zip64 ? 45 : 20, 2);
        put(file, flags, 2);
        put(file, method, 2);
        put(file, 0, 2);
        put(file, 33, 2);
        put(file, behind ? 0 : crc, 4);
        put(file, behind ? 0 : part.zip64 ? full : compressed_size, 4);
        put(file, behind ? 0 : part.zip64 ? full : inner_size, 4);
        put(file, inner_name.size(), 2);
        put(file, part.zip64 && !behind ? 20 : 0, 2);
        file += inner_name;
        if (part.zip64 && !behind) {
            put(file, 1, 2);
            put(file, 16, 2);
            put(file, inner_size, 8);
            put(file, compressed_size, 8);
        }
        file += compressed;
        if (behind) {
            put(file, 0x08074b50, 4);
            put(file, crc, 4);
            put(file, compressed_size, part.zip64 ? 8 : 4);
            put(file, size, part.zip64 ? 8 : 4);
        }

        put(directory, 0x02014b50, 4);
        put(directory, 45, 2);
        put(directory, part.zip64 ? 45 : 20, 2);
        put(directory, flags, 2);
        put(directory, method, 2);
        put(directory, 0, 2);
        put(directory, 33, 2);
        put(directory, crc, 4);
        put(directory, part.zip64 ? full : compressed_size, 4);
        put(directory, part.zip64 ? full : size, 4);
        put(directory, part.name.size(), 2);
        put(directory, part.zip64 ? 28 : 0, 2);
        put(directory, 0, 2);
        put(directory, part.disc, 2);
        put(directory, 0, 2);
        put(directory, 0, 4);
        put(directory, part.zip64 ? full : position, 4);
        directory += part.name;
        if (part.zip64) {
            put(directory, 1, 2);
            put(directory, 24, 2);
            put(directory, size, 8);
            put(directory, compressed_size, 8);
            put(directory, position, 8);
        }
    }
    const std::uint64_t directory_offset = end.directory_offset.value_or(file.size());
    const std::uint64_t directory_size = end.directory_size.value_or(directory.size());
    const std::uint64_t entries = end.entries.value_or(parts.size());
    file += directory;
    if (end.zip64) {
        const std::uint64_t position = file.size();
        put(file, 0x06064b50, 4);
        put(file, 44, 8);
        put(file, 45, 2);
        put(file, 45, 2);
        put(file, 0, 8);
        put(file, entries, 8);
        put(file, entries, 8);
        put(file, directory_size, 8);
        put(file, directory_offset, 8);
        put(file, 0x07064b50, 4);
        put(file, 0, 4);
        put(file, position, 8);
        put(file, 1, 4);
    }
    put(file, 0x06054b50, 4);
    put(file, 0, 4);
    put(file, end.zip64 ? 0xFFFF : entries, 2);
    put(file, end.zip64 ? 0xFFFF : entries, 2);
    put(file, end.zip64 ? full : directory_size, 4);
    put(file, end.zip64 ? full : directory_offset, 4);
    put(file, end.comment.size(), 2);
    return file + end.comment;
}

} // namespace lamella::zip_test
