#pragma once

// A file as bytes in memory, wherever they come from.

#include <cstddef>
#include <memory>
#include <span>
#include <stop_token>
#include <string>

namespace lamella {

/// The bytes of a file, at least one, and what keeps them alive. Cheap to copy.
struct ByteSource {
    std::string name; ///< as errors call it: the path, or "standard input"
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner; ///< the bytes live as long as any copy of this
};

/// Opens a file of any size. A regular file is memory-mapped: nothing is read before it is touched, and the
/// file must keep its length as long as the bytes live (the system ends a program that touches a page that is
/// gone with SIGBUS; renaming or deleting the file does no harm). What cannot be mapped, such as a pipe, is
/// read into memory to its end. "-" is standard input.
///
/// Throws Error{input} when the file is missing, empty, a directory, a device or may not be read, and
/// Error{cancelled} soon after a stop is requested, also while it waits for the other end of a pipe.
[[nodiscard]] ByteSource open_bytes(const std::string& path, const std::stop_token& cancel = {});

/// A copy of bytes in memory; `name` stands for the path in errors. Throws Error{input} when there are none.
[[nodiscard]] ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name);

} // namespace lamella
