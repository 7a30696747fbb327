#pragma once

// What the reader and the writer of zip archives both know of the format.

#include <cstdint>
#include <string>

namespace lamella {

/// The first four bytes of records.
constexpr std::uint32_t zip_entry_mark = 0x04034b50;
constexpr std::uint32_t zip_directory_mark = 0x02014b50;
constexpr std::uint32_t zip_end_mark = 0x06054b50;
constexpr std::uint32_t zip_end64_mark = 0x06064b50;
constexpr std::uint32_t zip_end64_place_mark = 0x07064b50;

/// A field that is full refers to the records of zip64.
constexpr std::uint64_t full16 = 0xFFFF;
constexpr std::uint64_t full32 = 0xFFFFFFFF;

constexpr std::uint16_t flag_sizes_behind = 1U << 3;

/// Others exist.
enum class ZipMethod : std::uint16_t { stored = 0, deflated = 8 };

/// What an archive says of an entry.
struct ZipEntry {
    std::string name; ///< with `/` between folders and none in front
    std::uint64_t size = 0;
    std::uint64_t packed_size = 0;
    std::uint64_t place =
        0; ///< of the packed bytes in what is read; of the head before them in what is written
    std::uint32_t crc = 0;
    ZipMethod method = ZipMethod::stored;
    std::uint16_t flags = 0;
};

} // namespace lamella
