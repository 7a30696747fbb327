#pragma once

// Puts the bytes of a fuzzer, which would never find valid checksums, into a zip archive.

#include <zlib.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace lamella::fuzz {

inline std::uint64_t checksum(std::string_view bytes) {
    return crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

/// A zip archive of stored entries.
class Archive {
  public:
    void add(std::string_view name, std::string_view content) {
        const std::size_t place = file_.size();
        const auto header = [&](std::string& out) {
            put(out, {20, 0, 0, 0, 33}, 2);
            put(out, {checksum(content), content.size(), content.size()}, 4);
            put(out, {name.size(), 0}, 2);
        };
        put(file_, {0x04034b50}, 4);
        header(file_);
        file_.append(name).append(content);
        put(directory_, {0x02014b50}, 4);
        put(directory_, {20}, 2);
        header(directory_);
        put(directory_, {0, 0, 0}, 2);
        put(directory_, {0, place}, 4);
        directory_.append(name);
        ++entries_;
    }

    std::string take() {
        const std::size_t place = file_.size();
        file_ += directory_;
        put(file_, {0x06054b50}, 4);
        put(file_, {0, 0, entries_, entries_}, 2);
        put(file_, {directory_.size(), place}, 4);
        put(file_, {0}, 2);
        return std::move(file_);
    }

  private:
    static void put(std::string& out, std::initializer_list<std::uint64_t> values, int bytes) {
        for (const std::uint64_t value : values)
            for (int i = 0; i < bytes; ++i)
                out += static_cast<char>(value >> (8 * i));
    }

    std::string file_;
    std::string directory_;
    std::uint64_t entries_ = 0;
};

/// Makes entries of these names, as many as there are bytes for. Two bytes, the lower one first, give the
/// length of each.
inline std::string archive_of(std::string_view bytes, std::initializer_list<std::string_view> names) {
    Archive archive;
    for (const std::string_view name : names) {
        if (bytes.size() < 2)
            break;
        const auto low = static_cast<unsigned char>(bytes[0]);
        const auto high = static_cast<unsigned char>(bytes[1]);
        bytes.remove_prefix(2);
        const std::string_view entry = bytes.substr(0, low + 256U * high);
        archive.add(name, entry);
        bytes.remove_prefix(entry.size());
    }
    return archive.take();
}

} // namespace lamella::fuzz
