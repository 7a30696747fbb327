#pragma once

// A file as bytes in memory, wherever they come from.

#include "lamella/core/execution.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

class OpenFile;

/// The bytes of a file, at least one, and what keeps them alive. Cheap to copy. Nobody else can change them:
/// they are a copy, unless the file is read in windows.
struct ByteSource {
    std::string name;                  ///< as errors call it: the path, or "standard input"
    std::span<const std::byte> bytes;  ///< all of them; of a file that is read in windows, the first ones
    std::shared_ptr<const void> owner; ///< the bytes live as long as any copy of this
    bool on_disk = false; ///< the bytes are in a temporary file, and come from it when they are touched
    std::shared_ptr<const OpenFile> file = {}; ///< of a file that is read in windows, by `copy_out`

    [[nodiscard]] std::string_view text() const noexcept {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    /// The size of the file in bytes.
    [[nodiscard]] std::uint64_t size() const noexcept;
    /// How much memory the bytes take.
    [[nodiscard]] std::uint64_t bytes_in_memory() const noexcept {
        return on_disk || file ? 0 : bytes.size();
    }
};

/// How much of a file that is read in windows is in memory from the start.
inline constexpr std::size_t window_beginning = std::size_t{1} << 16;

/// Whether a regular file of `size` bytes that begins like this is read in windows.
using WindowTest = bool(std::span<const std::byte> beginning, std::uint64_t size);

/// Opens a file of any size and copies its bytes, by all threads: whatever becomes of the file afterwards,
/// the bytes stay as they were read, and no signal ends the program. No more than `most_in_memory` bytes are
/// kept in memory: a longer file is copied to a temporary file without a name (system/spill_file.hpp), and
/// that is mapped. A regular file of at least `window_beginning` for which `in_windows` is true is not copied
/// but stays open, unless the process has many open files already. "-" is standard input.
///
/// Throws Error{input} when the file is missing, empty, a folder, a device, may not be read or becomes
/// shorter while it is read; Error{output} when there is no room for the temporary file; and Error{cancelled}
/// soon after a stop is requested, also while it waits for the other end of a pipe.
[[nodiscard]] ByteSource open_bytes(const std::string& path, const Execution& execution = {},
                                    std::uint64_t most_in_memory = ~std::uint64_t{0},
                                    WindowTest* in_windows = nullptr);

/// The same bytes as a copy of the whole file, where they are read in windows.
[[nodiscard]] ByteSource whole(const ByteSource& source, const Execution& execution,
                               std::uint64_t most_in_memory);

/// Copies the bytes from `offset` on into `to`, which they fill. Any number of threads at once. Throws
/// Error{input} when a file that is read in windows has become shorter.
void copy_out(const ByteSource& source, std::uint64_t offset, std::span<std::byte> to);

/// Lets go of the memory that a stretch of bytes on disk takes; when touched again, they come from there
/// again. So a file larger than memory can be gone through. Does nothing for bytes in memory.
void release(const ByteSource& source, std::span<const std::byte> stretch) noexcept;

/// A copy of bytes in memory; `name` stands for the path in errors. Throws Error{input} when there are none.
[[nodiscard]] ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name);

} // namespace lamella
