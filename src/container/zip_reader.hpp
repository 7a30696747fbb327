#pragma once

// Reading zip archives that somebody may have made to do harm.

#include "container/zip_format.hpp"
#include "core/byte_source.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Whether the bytes begin as a zip archive does.
[[nodiscard]] bool is_zip(std::string_view bytes) noexcept;

/// The entries of a zip archive, zip64 included, sizes in front of the bytes or behind them. Nothing is
/// unpacked before it is read, and nothing is allocated from what the archive claims: an entry gets room for
/// its claimed size only where Deflate can reach that from the bytes that are there, and memory is taken as
/// they fill it.
///
/// Refused with Error{input}, as two readers might see two contents: several discs, entries that reach into
/// one another or beyond the file, two entries of a name, a name or size that the directory and the entry
/// itself tell differently. Entries that are encrypted or packed by other methods than Deflate are refused
/// when they are read.
class ZipReader {
  public:
    /// Reads the directory. At most `max_unpacked` bytes will be unpacked in all, stored ones included; 0
    /// means `usual_most_unpacked`.
    ZipReader(ByteSource source, std::uint64_t max_unpacked);

    /// In the order of the directory; without folders.
    [[nodiscard]] const std::vector<ZipEntry>& entries() const noexcept { return entries_; }

    /// The entry of that name (without a slash in front), or else one that differs in the case of ASCII
    /// letters only, of several the first in the order of their bytes; null when there is none.
    [[nodiscard]] const ZipEntry* find(std::string_view name) const noexcept;

    /// The bytes of an entry, CRC checked; they may be none. Stored ones are a view of the archive. The name
    /// tells archive and entry. May be called from several threads. Throws Error{input} when the entry is
    /// damaged or not what it claims, and Error{limit} when the bytes are too many.
    [[nodiscard]] ByteSource read(const ZipEntry& entry) const;

    /// Up to `most` of the first bytes of an entry, to see what it is: no more are unpacked, nothing is
    /// checked, and they do not count. None where the entry cannot be read.
    [[nodiscard]] std::string first_bytes(const ZipEntry& entry, std::size_t most) const;

    /// What is odd about the archive, one line each.
    [[nodiscard]] const std::vector<std::string>& oddities() const noexcept { return oddities_; }
    [[nodiscard]] const std::string& name() const noexcept { return source_.name; }
    /// Bytes that entries took when they were read.
    [[nodiscard]] std::uint64_t unpacked() const noexcept { return unpacked_.load(); }

  private:
    void read_directory();
    void settle_places(std::uint64_t directory_place);
    void settle_names();

    ByteSource source_;
    std::uint64_t max_unpacked_;
    mutable std::atomic<std::uint64_t> unpacked_{0};
    std::vector<ZipEntry> entries_;
    std::vector<std::size_t> by_name_; ///< entries in the order of their names
    std::vector<std::string> oddities_;
};

} // namespace lamella
