#pragma once

// The format of zip archives, for the reader and the writer.

#include <cstdint>
#include <string>

namespace lamella {

/// Signatures: the first four bytes of each kind of record.
constexpr std::uint32_t zip_entry_signature = 0x04034b50;
constexpr std::uint32_t zip_directory_signature = 0x02014b50;
constexpr std::uint32_t zip_end_signature = 0x06054b50;
constexpr std::uint32_t zip_end64_signature = 0x06064b50;
constexpr std::uint32_t zip_end64_locator_signature = 0x07064b50;

/// A field with this value refers to the zip64 records, which have the actual value.
constexpr std::uint64_t full16 = 0xFFFF;
constexpr std::uint64_t full32 = 0xFFFFFFFF;

constexpr std::uint16_t flag_sizes_behind = 1U << 3;

/// Supported methods; the format has others.
enum class ZipMethod : std::uint16_t { stored = 0, deflated = 8 };

/// Directory record of an entry.
struct ZipEntry {
    std::string name; ///< with `/` between folders, without a leading `/`
    std::uint64_t size = 0;
    std::uint64_t compressed_size = 0;
    std::uint64_t offset =
        0; ///< in the reader, offset of the compressed bytes; in the writer, offset of the entry's header
    std::uint32_t crc = 0;
    ZipMethod method = ZipMethod::stored;
    std::uint16_t flags = 0;
};

} // namespace lamella
