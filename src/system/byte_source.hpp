#pragma once

// The bytes of a file, from any source.

#include "lamella/core/execution.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

class OpenFile;

/// The bytes of a file, at least one, and the owner of their memory. Cheap to copy. They are a copy that no
/// other process can change, unless the file is read in windows (opened and read in chunks on demand).
struct ByteSource {
    std::string name;                  ///< name in errors: the path, or "standard input"
    std::span<const std::byte> bytes;  ///< all bytes, or the first ones of a file that is read in windows
    std::shared_ptr<const void> owner; ///< the bytes live as long as any copy of this
    bool on_disk = false; ///< true if the bytes are in a temporary file, and are read from it when accessed
    std::shared_ptr<const OpenFile> file = {}; ///< set if the file is read in windows, by `copy_out`

    [[nodiscard]] std::string_view text() const noexcept {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    /// Returns the size of the file in bytes.
    [[nodiscard]] std::uint64_t size() const noexcept;
    /// Returns the number of bytes of memory that the bytes take.
    [[nodiscard]] std::uint64_t bytes_in_memory() const noexcept {
        return on_disk || file ? 0 : bytes.size();
    }
};

/// Number of bytes at the beginning of a file that are in memory if it is read in windows.
inline constexpr std::size_t window_beginning = std::size_t{1} << 16;

/// Returns true if a regular file of `size` bytes with this beginning is to be read in windows.
using WindowTest = bool(std::span<const std::byte> beginning, std::uint64_t size);

/// Opens a file of any size and copies its bytes, with all threads. If the file changes or shrinks
/// afterwards, the copy does not, and no signal ends the program. At most `most_in_memory` bytes are kept in
/// memory: a longer file is copied to a temporary file without a name (system/spill_file.hpp), which is
/// mapped. A regular file of at least `window_beginning` bytes for which `in_windows` returns true is not
/// copied but stays open, unless the process already has many open files. "-" is standard input.
///
/// Throws Error{input} if the file is missing, empty, a folder or a device, is not readable, or becomes
/// shorter while it is read; Error{output} if there is no space for the temporary file; and Error{cancelled}
/// soon after a stop is requested, also while it waits for the other end of a pipe.
[[nodiscard]] ByteSource open_bytes(const std::string& path, const Execution& execution = {},
                                    std::uint64_t most_in_memory = ~std::uint64_t{0},
                                    WindowTest* in_windows = nullptr);

/// Returns a copy of the whole file if it is read in windows, else `source`.
[[nodiscard]] ByteSource whole(const ByteSource& source, const Execution& execution,
                               std::uint64_t most_in_memory);

/// Copies the bytes from `offset` on until `to` is full. May be called by any number of threads at once.
/// Throws Error{input} if a file that is read in windows has become shorter.
void copy_out(const ByteSource& source, std::uint64_t offset, std::span<std::byte> to);

/// Frees the memory of a range of bytes that are on disk; if accessed again, they are read from disk again.
/// Files larger than memory can thus be traversed. Does nothing for bytes in memory.
void release(const ByteSource& source, std::span<const std::byte> range) noexcept;

/// Returns an execution whose progress also releases the bytes that were read. For readers that go from front
/// to back and report the bytes they have read; any others read released bytes from the disk again.
[[nodiscard]] Execution releasing(const ByteSource& source, const Execution& execution);

/// Copies bytes in memory; `name` replaces the path in errors. Throws Error{input} if there are no bytes.
[[nodiscard]] ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name);

} // namespace lamella
