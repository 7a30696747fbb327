#pragma once

// Reads untrusted PNG files as runs of grey pixels.

#include "lamella/slices/image_options.hpp"

#include "container/read_limits.hpp"
#include "slices/images/run_builder.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// Returns the columns and rows of a PNG file, of which the first 33 bytes are enough. Throws Error{input} if
/// it is none.
[[nodiscard]] AlongXY<std::uint32_t> png_size(std::string_view file, const std::string& name);

/// Decodes the image. Greys of fewer than 8 bits become 0 to 255, colours their largest part, and what is
/// transparent black. Of a palette with transparent colours, only how opaque they are counts: all others are
/// 255, as in images by part. Three columns may be the colours of one pixel, as some printers expect it.
/// Throws Error{input} for damaged files, other sizes than that of the image, interlaced files, and 16 bits.
void decode_png(std::string_view file, const std::string& name, RunBuilder& image, ReadLimits& limits);

} // namespace lamella
