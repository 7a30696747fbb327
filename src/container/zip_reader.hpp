#pragma once

// Reads untrusted zip archives.

#include "container/zip_format.hpp"
#include "system/byte_source.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

class Executor;

/// Returns whether the bytes begin with a signature of zip archives.
[[nodiscard]] bool is_zip(std::string_view bytes) noexcept;

/// The entries of a zip archive, with or without zip64; sizes may precede or follow the compressed bytes. An
/// entry is decompressed only when it is read. Its claimed size is accepted only if Deflate can produce it
/// from the available bytes, and pages of memory are used only when they are filled (by one thread).
///
/// Throws Error{input} for archives that two readers could interpret differently: with several discs, entries
/// that overlap or exceed the file, duplicate names, or a name or size that differs between the directory and
/// the entry. Encrypted entries and methods other than Deflate are refused when they are read.
class ZipReader {
  public:
    /// Reads the directory. `max_unpacked` limits the bytes of all entries that are read, decompressed or
    /// stored, each counted once; 0 means `usual_most_unpacked`.
    ZipReader(ByteSource source, std::uint64_t max_unpacked);

    /// Returns the entries except folders, in the order of the directory.
    [[nodiscard]] const std::vector<ZipEntry>& entries() const noexcept { return entries_; }

    /// Returns the entry with this name (without a leading slash). Otherwise returns, of the entries whose
    /// names differ only in the case of ASCII letters, the first in byte order; null if there is none.
    [[nodiscard]] const ZipEntry* find(std::string_view name) const noexcept;

    /// Returns the bytes of an entry, which may be empty, after verifying their CRC. The bytes of a stored
    /// entry are a view of the archive. The name of the source contains those of archive and entry. May be
    /// called from several threads. Throws Error{input} if the entry is damaged or differs from its record,
    /// and Error{limit} if the bytes exceed the limit. `count` is called with the number of bytes before
    /// memory is allocated for them. Several threads of `helpers` provide all of this memory at once, which
    /// may take one thread longer than decompression, and verify the CRC.
    [[nodiscard]] ByteSource read(const ZipEntry& entry, const std::function<void(std::uint64_t)>& count = {},
                                  Executor* helpers = nullptr) const;

    /// Returns at most `most` of the first bytes of an entry, to detect its format; "" if the entry cannot be
    /// read. They are not verified and do not count towards the limit.
    [[nodiscard]] std::string first_bytes(const ZipEntry& entry, std::size_t most) const;

    /// Returns warnings about the archive, one line each.
    [[nodiscard]] const std::vector<std::string>& counted_warnings() const noexcept {
        return counted_warnings_;
    }
    [[nodiscard]] const std::string& name() const noexcept { return source_.name; }
    /// Returns the number of bytes of the entries that were read, each counted once.
    [[nodiscard]] std::uint64_t unpacked() const noexcept { return unpacked_.load(); }

  private:
    void read_directory();
    void settle_offsets(std::uint64_t directory_offset);
    void settle_names();

    ByteSource source_;
    std::uint64_t max_unpacked_;
    mutable std::atomic<std::uint64_t> unpacked_{0};
    std::vector<ZipEntry> entries_;
    mutable std::vector<std::atomic<bool>> was_read_; ///< of each entry
    std::vector<std::size_t> by_name_;                ///< indices of entries in the order of their names
    std::vector<std::string> counted_warnings_;
};

} // namespace lamella
