#pragma once

// Reads untrusted zip archives.

#include "container/zip_format.hpp"
#include "system/byte_source.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Returns whether the bytes begin with a signature of zip archives.
[[nodiscard]] bool is_zip(std::string_view bytes) noexcept;

/// The entries of a zip archive, including zip64; sizes may precede or follow the compressed bytes. An entry
/// is decompressed only when it is read. Its claimed size is accepted only if Deflate can reach it from the
/// available bytes, and pages of memory are used only as they are filled.
///
/// Refuses, with Error{input}, archives that two readers could interpret differently: several discs, entries
/// that overlap or exceed the file, duplicate names, and a name or size that differs between the directory
/// and the entry. Encrypted entries and methods other than Deflate are refused when they are read.
class ZipReader {
  public:
    /// Reads the directory. At most `max_unpacked` bytes will be decompressed in total, including stored
    /// ones; 0 means `usual_most_unpacked`.
    ZipReader(ByteSource source, std::uint64_t max_unpacked);

    /// Returns the entries in the order of the directory, without folders.
    [[nodiscard]] const std::vector<ZipEntry>& entries() const noexcept { return entries_; }

    /// Returns the entry with this name (without a leading slash). If there is none, returns the first, in
    /// byte order, of those that differ only in the case of ASCII letters, or null.
    [[nodiscard]] const ZipEntry* find(std::string_view name) const noexcept;

    /// Returns the bytes of an entry, perhaps none, after verifying their CRC. The bytes of a stored entry
    /// are a view of the archive. The name of the source names archive and entry. May be called from several
    /// threads. Throws Error{input} if the entry is damaged or differs from its record, and Error{limit} if
    /// the bytes exceed the limit.
    [[nodiscard]] ByteSource read(const ZipEntry& entry) const;

    /// Returns up to `most` of the first bytes of an entry, to detect its format. They are not verified and
    /// do not count towards the limit. Returns none if the entry cannot be read.
    [[nodiscard]] std::string first_bytes(const ZipEntry& entry, std::size_t most) const;

    /// Returns warnings about the archive, one line each.
    [[nodiscard]] const std::vector<std::string>& counted_warnings() const noexcept {
        return counted_warnings_;
    }
    [[nodiscard]] const std::string& name() const noexcept { return source_.name; }
    /// Returns the number of bytes read from entries.
    [[nodiscard]] std::uint64_t unpacked() const noexcept { return unpacked_.load(); }

  private:
    void read_directory();
    void settle_offsets(std::uint64_t directory_offset);
    void settle_names();

    ByteSource source_;
    std::uint64_t max_unpacked_;
    mutable std::atomic<std::uint64_t> unpacked_{0};
    std::vector<ZipEntry> entries_;
    std::vector<std::size_t> by_name_; ///< indices of entries in the order of their names
    std::vector<std::string> counted_warnings_;
};

} // namespace lamella
