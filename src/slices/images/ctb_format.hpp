#pragma once

// Numbers of Chitubox's formats that their reader and their writer share.

#include <cstdint>

namespace lamella {

/// The first number of files with black and white images, and of those with grey ones up to version 3 and
/// from version 4 on.
inline constexpr std::uint32_t cbddlp_magic = 0x12FD0019;
inline constexpr std::uint32_t ctb_magic = 0x12FD0086;
inline constexpr std::uint32_t ctb4_magic = 0x12FD0106;

inline constexpr std::uint64_t ctb_entry_bytes = 36; ///< of a layer in the table

} // namespace lamella
