#pragma once

// Images as PNG files.

#include "lamella/raster/image.hpp"
#include "lamella/slices/image_options.hpp"

#include "container/byte_buffer.hpp"
#include "raster/relief.hpp"
#include "slices/images/run_deflate.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The kind of pixels of a PNG file.
struct PngPixels {
    /// Bits of a pixel: 1 or 8 of grey; 1, 2, 4 or 8 of a number in the palette.
    unsigned bits = 8;
    /// The colours of pixels by their values, beginning with that of value 0, which is transparent. If it is
    /// empty, values are grey.
    std::vector<PartColour> palette = {};
};

/// Makes PNG files of one size, one after the other, from rows of runs. They are not interlaced, and contain
/// only header, palette, pixels and end. The time grows with the number of runs, plus one step for each 258
/// bytes of a run: pixels are not processed one by one.
class PngEncoder {
  public:
    PngEncoder(std::uint32_t width, std::uint32_t height, PngPixels pixels = {});

    /// Adds the next rows, from the top (see RowSink). Values of one bit of grey are 0 and 255, and those of
    /// a palette are numbers in it.
    void add(std::span<const PixelRun> pixels, std::uint32_t times);
    /// Appends the file; must be called after the last row.
    void finish(ByteBuffer& out);

  private:
    /// Returns the row as runs of bytes.
    [[nodiscard]] std::span<const PixelRun> packed(std::span<const PixelRun> row);
    /// Adds one row unchanged, or as its differences from the row above if these have fewer runs.
    void add_row(std::span<const PixelRun> row);
    /// Finds the differences from the row above. Stops and returns false if they do not have fewer runs than
    /// the row.
    bool find_differences(std::span<const PixelRun> row);

    std::uint32_t width_;
    std::uint32_t height_;
    PngPixels pixels_;
    std::uint32_t row_bytes_;
    std::vector<PixelRun> bytes_;       ///< of a row with several pixels in a byte
    std::vector<PixelRun> above_;       ///< empty before the first row
    std::vector<PixelRun> differences_; ///< the first `difference_count_` are valid
    std::size_t difference_count_ = 0;
    RunDeflater deflater_;
};

/// Appends a colour image as a PNG file.
void append_png(const ColourImage& image, ByteBuffer& out);

} // namespace lamella
