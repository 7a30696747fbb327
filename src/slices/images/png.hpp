#pragma once

// Images as PNG files.

#include "lamella/raster/image.hpp"

#include "container/byte_buffer.hpp"
#include "raster/relief.hpp"
#include "slices/images/run_deflate.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Makes PNG files of one size, one after the other, from rows of runs. They have 8 bits of grey, are not
/// interlaced, and contain only header, pixels and end. The time grows with the number of runs, plus one step
/// for each 258 pixels of a run: pixels are not processed one by one.
class PngEncoder {
  public:
    PngEncoder(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}

    /// Adds the next rows, from the top (see RowSink).
    void add(std::span<const PixelRun> row, std::uint32_t times);
    /// Appends the file; must be called after the last row.
    void finish(ByteBuffer& out);

  private:
    /// Adds one row unchanged, or as its differences from the row above if these have fewer runs.
    void add_row(std::span<const PixelRun> row);
    /// Finds the differences from the row above. Stops and returns false if they do not have fewer runs than
    /// the row.
    bool find_differences(std::span<const PixelRun> row);

    std::uint32_t width_;
    std::uint32_t height_;
    std::vector<PixelRun> above_;       ///< empty before the first row
    std::vector<PixelRun> differences_; ///< the first `difference_count_` are valid
    std::size_t difference_count_ = 0;
    RunDeflater deflater_;
};

/// Appends a colour image as a PNG file.
void append_png(const ColourImage& image, ByteBuffer& out);

} // namespace lamella
