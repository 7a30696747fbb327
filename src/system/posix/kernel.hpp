#pragma once

// What POSIX does not offer. kernel_linux.cpp implements it for Linux. Other systems share kernel_unix.cpp,
// and have kernel_macos.cpp, or kernel_plain.cpp with what POSIX has instead. Functions that return a
// descriptor return -1 on failure; those that return bool return false. They set errno.

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace lamella {

/// Opens a file without a name; EOPNOTSUPP if there are no such files.
[[nodiscard]] int open_nameless(const std::string& folder, mode_t permissions) noexcept;
/// Returns whether `link_nameless` can name such a file.
[[nodiscard]] bool can_link_nameless(int descriptor) noexcept;
[[nodiscard]] bool link_nameless(int descriptor, const char* name) noexcept;

/// Exchanges two names at once.
[[nodiscard]] bool exchange_names(const char* one, const char* other) noexcept;
/// Returns whether a folder is a mount point.
[[nodiscard]] bool is_mounted(const char* folder) noexcept;
/// Removes the files in a folder. Async-signal-safe on Linux and macOS.
void unlink_entries(int folder) noexcept;
/// Returns a text that is the same for all processes of this machine until it is rebooted; "" if there is
/// none.
[[nodiscard]] std::string boot_id();

/// Returns whether a descriptor can be neither read nor written.
[[nodiscard]] bool is_path_only(int descriptor) noexcept;
void prefer_read_ahead(int descriptor) noexcept;
/// Reserves disk space. Returns 0, or an errno; EINTR if it is to be tried again.
[[nodiscard]] int reserve_blocks(int descriptor, std::uint64_t bytes) noexcept;
/// Frees disk space.
void punch_hole(int descriptor, std::uint64_t offset, std::uint64_t bytes) noexcept;

/// Resizes memory of mmap, which may move. Returns MAP_FAILED if there is not enough.
[[nodiscard]] void* resize_mapping(void* data, std::size_t size, std::size_t new_size) noexcept;

} // namespace lamella
