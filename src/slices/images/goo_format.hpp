#pragma once

// Numbers of the format .goo that its reader and its writer share.

#include <cstdint>
#include <string_view>

namespace lamella {

inline constexpr std::string_view goo_magic("\x07\0\0\0DLP\0", 8);
inline constexpr std::string_view goo_delimiter = "\r\n";
inline constexpr std::string_view goo_tail("\0\0\0\x07\0\0\0DLP\0", 11);
inline constexpr std::uint64_t goo_head_bytes = 195477;
inline constexpr std::uint64_t goo_layer_bytes = 70; ///< before the image of a layer

} // namespace lamella
