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

/// The bytes of a file, at least one, and what keeps them alive. Cheap to copy.
struct ByteSource {
    std::string name; ///< as errors call it: the path, or "standard input"
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner; ///< the bytes live as long as any copy of this
    bool mapped = false;               ///< they are those of a file, and come from it when they are touched
    int descriptor = -1;               ///< of that file, if it is kept; the owner's

    [[nodiscard]] std::string_view text() const noexcept {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
};

/// Opens a file of any size. A regular file is memory-mapped: nothing is read before it is touched, and the
/// file must keep its length as long as the bytes live (the system ends a program that touches a page that is
/// gone with SIGBUS; renaming or deleting the file does no harm). It stays open as long as the bytes live,
/// unless the process has many open files already. A file of less than 64 KB is read at once, and what cannot
/// be mapped, such as a pipe, to its end. "-" is standard input.
///
/// Throws Error{input} when the file is missing, empty, a folder, a device or may not be read, and
/// Error{cancelled} soon after a stop is requested, also while it waits for the other end of a pipe.
///
/// Of what cannot be mapped no more than `most_in_memory` bytes are kept in memory: what is longer goes to a
/// spill file (core/spill_file.hpp), and that is mapped. Throws Error{output} when there is no room for it.
[[nodiscard]] ByteSource open_bytes(const std::string& path, const Execution& execution = {},
                                    std::uint64_t most_in_memory = ~std::uint64_t{0});

/// Copies the bytes from `place` on into `to`, which they fill. Bytes of a file are read from it, where that
/// can be: then no signal tells that it has become shorter, and no page has to be mapped. Any number of
/// threads at once. Throws Error{input} when the file has become shorter.
void copy_out(const ByteSource& source, std::uint64_t place, std::span<std::byte> to);

/// To be called by who has read the bytes. Throws Error{input} when their file has become shorter meanwhile:
/// in the page of its new end, bytes that are gone read as zeros, without any signal. Costs a question to the
/// system; without a descriptor, nobody can tell.
void check_length(const ByteSource& source);

/// Lets go of the memory that a stretch of mapped bytes takes; when touched again, they come from the file
/// again. So a file larger than memory can be gone through. Does nothing for bytes that are not mapped.
void release(const ByteSource& source, std::span<const std::byte> stretch) noexcept;

/// A copy of bytes in memory; `name` stands for the path in errors. Throws Error{input} when there are none.
[[nodiscard]] ByteSource copy_bytes(std::span<const std::byte> bytes, std::string name);

} // namespace lamella
