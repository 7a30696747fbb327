#pragma once

// Stores data on disk that do not fit into memory.

#include "system/native_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lamella {

/// A temporary file that exists as long as this object. It is unnamed, so it disappears no matter how the
/// program ends.
///
/// It is in scratch_folder(). All failures are Error{output} with the name of this folder. Any number of
/// threads may use it at once.
class SpillFile {
  public:
    /// `bytes` is the total size, 0 if unknown. A disk with less free space is refused before any of it is
    /// taken. If the file system supports it, the space is reserved at once, so that a full disk is detected
    /// before the work is done. `of_all` is the total size of several
    /// such files, for errors.
    explicit SpillFile(std::uint64_t bytes = 0, std::uint64_t of_all = 0);

    void write(std::uint64_t offset, std::span<const std::byte> bytes);
    void read(std::uint64_t offset, std::span<std::byte> bytes) const;
    /// Frees the disk space of a range of bytes, if the file system supports it. The range must not be read
    /// again.
    void forget(std::uint64_t offset, std::uint64_t bytes) noexcept;

    [[nodiscard]] const NativeFile& file() const noexcept { return file_; }

  private:
    [[noreturn]] void fail(int system_error) const;

    std::string folder_;
    std::uint64_t bytes_; ///< size for errors
    NativeFile file_;
};

} // namespace lamella
