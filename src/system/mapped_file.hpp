#pragma once

// A file as a range of memory.

#include "system/native_file.hpp"

#include <cstddef>
#include <span>

namespace lamella {

/// A mapped file, to be read from front to back. No other process may be able to shorten the file, because
/// access to bytes that no longer exist ends the process. The file need not stay open by
/// its owner. Throws std::bad_alloc.
class MappedFile {
  public:
    /// `bytes` must be the size of the file, and not 0.
    MappedFile(const NativeFile& file, std::size_t bytes);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }

  private:
    std::byte* data_;
    std::size_t size_;
    NativeFile kept_open_; ///< where the file must not be closed before it is unmapped
};

/// Frees the memory of a range of a mapped file; if accessed again, it is read from the file again.
/// `from_start` are all bytes of the mapping up to the end of the range.
void release_mapped(std::span<const std::byte> from_start, std::span<const std::byte> range) noexcept;

} // namespace lamella
