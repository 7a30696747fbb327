#pragma once

// Numbers of SLC 2.0, of 3D Systems.

#include <cstddef>
#include <cstdint>

namespace lamella::slc {

/// Bytes between the header and the sampling table.
inline constexpr std::size_t reserved = 256;
/// The number of contours that ends the file.
inline constexpr std::uint32_t no_more_layers = 0xFFFFFFFF;

} // namespace lamella::slc
