#pragma once

// Writing zip archives from front to back.

#include "container/zip_format.hpp"
#include "core/atomic_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Bytes of an entry that were made ready beforehand, perhaps on another thread.
struct ZipPiece {
    std::string_view bytes; ///< as they stand in the archive: of Deflater for deflated entries
    std::uint64_t size = 0; ///< how many bytes they stand for
    std::uint32_t crc = 0;  ///< of those (`crc32_of`)
};

/// A zip archive that appears whole or not at all, as AtomicFile. Equal contents give equal bytes: all
/// entries have the time 1980-01-01 00:00.
///
/// Entries follow one another in the order of the calls; their names are unique, relative and have `/`
/// between folders, which the caller sees to. Sizes stand in front of entries, but behind those that are
/// deflated piece by piece (a data descriptor): of stored ones nobody who reads from front to back could tell
/// where they end. The 64-bit forms of sizes and places (zip64) are used where the 32-bit ones do not
/// suffice, and nowhere else.
///
/// For one thread at a time, but for `bytes`. Failures are Error{output}.
class ZipWriter {
  public:
    /// Without Overwriting::yes nothing is written twice: the bytes can go to a pipe as they come.
    explicit ZipWriter(std::string path, Overwriting overwriting = Overwriting::no);

    /// One entry, whole. Deflating happens here.
    void add(std::string_view name, std::string_view content, ZipMethod method = ZipMethod::stored);
    /// One entry, whole, made ready beforehand. When deflated, `bytes` is a stream with its end.
    void add_ready(std::string_view name, ZipMethod method, const ZipPiece& content);

    /// Begins an entry that comes piece by piece, and ends it. A stored one goes with Overwriting::yes; its
    /// first `head_size` bytes may be known at its end only.
    void begin(std::string_view name, ZipMethod method, std::size_t head_size = 0);
    void append(const ZipPiece& piece);
    void append_stored(std::string_view content);
    void end(std::string_view head = {});

    /// Writes the directory and gives the file its name. To be called once, after the last entry.
    void finish();

    /// Bytes written so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return file_.bytes(); }

  private:
    ZipEntry& add_entry(std::string_view name, ZipMethod method, bool sizes_behind);
    void append_directory();

    AtomicFile file_;
    std::vector<ZipEntry> entries_;
    bool open_ = false; ///< an entry has begun and not ended
};

} // namespace lamella
