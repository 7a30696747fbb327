#pragma once

// Images as PNG files.

#include "lamella/raster/image.hpp"

#include "raster/relief.hpp"
#include "write/byte_buffer.hpp"
#include "write/run_deflate.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Makes PNG files of one size from rows of runs: 8 bits of grey, not interlaced, with header, pixels and end
/// only. The time grows with the number of runs, plus one step for each 258 pixels within them: no pixel is
/// ever touched. Makes one image after the other.
class PngEncoder {
  public:
    PngEncoder(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}

    /// Adds the next rows, from the top (see RowSink).
    void add(std::span<const PixelRun> row, std::uint32_t times);
    /// Appends the file; must be called after the last row.
    void finish(ByteBuffer& out);

  private:
    /// Adds one row, as it is or as its differences from the one above, whichever has fewer runs.
    void add_row(std::span<const PixelRun> row);
    /// Returns whether the differences have fewer runs than the row; if not, they are not all found.
    bool find_differences(std::span<const PixelRun> row);

    std::uint32_t width_;
    std::uint32_t height_;
    std::vector<PixelRun> above_;       ///< empty before the first row
    std::vector<PixelRun> differences_; ///< the first `difference_count_` are valid
    std::size_t difference_count_ = 0;
    RunDeflater deflater_;
};

/// Appends an image in colours as a PNG file.
void append_png(const ColourImage& image, ByteBuffer& out);

} // namespace lamella
