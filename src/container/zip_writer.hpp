#pragma once

// Writes zip archives sequentially.

#include "container/zip_format.hpp"
#include "system/atomic_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Bytes of an entry that were prepared beforehand, perhaps by another thread.
struct ZipChunk {
    std::string_view bytes; ///< the bytes in the archive: output of Deflater for deflated entries
    std::uint64_t size = 0; ///< number of uncompressed bytes
    std::uint32_t crc = 0;  ///< CRC of the uncompressed bytes (`crc32_of`)
};

/// A zip archive that appears complete or not at all, like AtomicFile. Equal contents give equal bytes,
/// because all entries have the time 1980-01-01 00:00.
///
/// Entries are in the order of the calls. The caller ensures that their names are unique and relative, with
/// `/` between folders. Sizes precede the bytes of an entry, so that a sequential reader finds their end.
/// Only if an entry is deflated in chunks, sizes follow (as a data descriptor), because the end of a Deflate
/// stream can be recognised. 64-bit sizes and offsets (zip64) are used only where 32 bits do not suffice.
///
/// For one thread at a time, except `bytes`. Failures are Error{output}.
class ZipWriter {
  public:
    /// Without Overwriting::yes no byte is written twice, so the output can be a pipe.
    explicit ZipWriter(std::string path, Overwriting overwriting = Overwriting::no);

    /// Adds a whole entry, and compresses it if the method is deflated.
    void add(std::string_view name, std::string_view content, ZipMethod method = ZipMethod::stored);
    /// Adds a whole entry that was prepared beforehand. If it is deflated, `bytes` is a stream with its end.
    void add_ready(std::string_view name, ZipMethod method, const ZipChunk& content);

    /// begin() and end() enclose an entry that is written in chunks. A stored entry requires
    /// Overwriting::yes; `end` may then replace its first `header_size` bytes.
    void begin(std::string_view name, ZipMethod method, std::size_t header_size = 0);
    void append(const ZipChunk& chunk);
    void append_stored(std::string_view content);
    void end(std::string_view header = {});

    /// Writes the directory and gives the file its name. Must be called once, after the last entry.
    void finish();

    /// Returns the number of bytes written so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return file_.bytes(); }

  private:
    ZipEntry& add_entry(std::string_view name, ZipMethod method, bool sizes_behind);
    void append_directory();

    AtomicFile file_;
    std::vector<ZipEntry> entries_;
    bool open_ = false; ///< an entry has begun and not ended
};

} // namespace lamella
