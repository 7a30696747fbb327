#pragma once

// Pictures as PNG files.

#include "lamella/raster/picture.hpp"

#include "raster/relief.hpp"
#include "write/byte_buffer.hpp"
#include "write/run_deflate.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Makes PNG files of one size from rows of runs: 8 bits of grey, not interlaced, nothing in them but the
/// head, the pixels and the end. The time goes with the number of runs, and with 258 pixels to a step between
/// them: no pixel is ever touched. One picture after the other.
class PngEncoder {
  public:
    PngEncoder(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}

    /// The next rows, from the top (see RowSink).
    void add(std::span<const PixelRun> row, std::uint32_t times);
    /// Appends the file; to be called after the last row.
    void finish(ByteBuffer& out);

  private:
    /// One row, as it is or as its differences from the one above, whichever has fewer runs.
    void add_row(std::span<const PixelRun> row);
    /// Says whether there are fewer runs of them than of the row; else they are not all found.
    bool find_differences(std::span<const PixelRun> row);

    std::uint32_t width_;
    std::uint32_t height_;
    std::vector<PixelRun> above_;       ///< empty before the first row
    std::vector<PixelRun> differences_; ///< the first `difference_count_` of them; the rest is room
    std::size_t difference_count_ = 0;
    RunDeflater deflater_;
};

/// Appends a picture in colours as a PNG file.
void append_png(const ColourPicture& picture, ByteBuffer& out);

} // namespace lamella
