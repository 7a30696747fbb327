#pragma once

// Writes zip archives sequentially.

#include "lamella/core/commit.hpp"

#include "container/zip_format.hpp"
#include "system/atomic_file.hpp"

#include <cstdint>
#include <deque>
#include <memory>
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
/// For one thread at a time, except `bytes` and the completions. Failures are Error{output}.
class ZipWriter {
  public:
    /// Without Overwriting::yes no byte is written twice, so the output can be a pipe. `memory` as for
    /// AtomicFile.
    explicit ZipWriter(std::string path, Overwriting overwriting = Overwriting::no,
                       std::string* memory = nullptr);

    /// Adds a whole entry, and compresses it if the method is deflated.
    void add(std::string_view name, std::string_view content, ZipMethod method = ZipMethod::stored);
    /// Adds a whole entry that was prepared beforehand. If it is deflated, `bytes` is a stream with its end.
    /// `owner` keeps the bytes alive until the completions are done, which may write them.
    void add_ready(std::string_view name, ZipMethod method, const ZipChunk& content,
                   std::shared_ptr<const void> owner, Completions& after);

    /// begin() and end() enclose an entry that is written in chunks. A stored entry requires
    /// Overwriting::yes; `end` may then replace its first `header_size` bytes. Completions must be done
    /// before `end`.
    void begin(std::string_view name, ZipMethod method, std::size_t header_size = 0);
    void append(const ZipChunk& chunk);
    void append(const ZipChunk& chunk, std::shared_ptr<const void> owner, Completions& after);
    void append_stored(std::string_view content);
    /// Also leaves the CRC to the completions.
    void append_stored(std::string_view content, std::shared_ptr<const void> owner, Completions& after);
    void end(std::string_view header = {});

    /// Writes the directory and gives the file its name. Must be called once, after the last entry.
    void finish();

    /// Returns the number of bytes written so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return file_.bytes(); }

  private:
    /// CRC and number of uncompressed bytes of a chunk.
    struct Sum {
        std::uint32_t crc = 0;
        std::uint64_t size = 0;
    };

    void add_sum(const ZipChunk& chunk);
    ZipEntry& add_entry(std::string_view name, ZipMethod method, bool sizes_behind);
    void append_header(std::string_view name, ZipMethod method, const ZipChunk& content);
    void append_directory();

    AtomicFile file_;
    std::vector<ZipEntry> entries_;
    bool open_ = false;    ///< an entry has begun and not ended
    std::deque<Sum> sums_; ///< of the chunks of the open entry; completions set the CRC of some
};

} // namespace lamella
