#pragma once

// Images as runs of equal pixels, as the files of resin printers store them.

#include "lamella/raster/image.hpp"

#include "container/byte_buffer.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace lamella {

/// A code of images as runs. Runs continue from one row to the next.
struct RunCode {
    /// The value of a run for each value of a pixel: neighbours are joined if these values are equal.
    std::array<std::uint8_t, 256> joined{};
    /// The value that a reader gets for each value of a pixel.
    std::array<std::uint8_t, 256> read_back{};
    /// Appends a run of pixels.
    void (*put)(std::uint8_t value, std::uint64_t pixels, ByteBuffer& out) = nullptr;
    /// Bytes before the first run.
    std::string_view begin = {};
    /// Appends what follows the last run of an image, which begins at this position of the buffer. Null if
    /// nothing follows.
    void (*close)(std::size_t image, ByteBuffer& out) = nullptr;
};

/// Encodes one image. Its time grows with the number of runs: pixels are not processed one by one.
class RunEncoder {
  public:
    /// Appends the image to `out`. The code must outlive the encoder.
    RunEncoder(const RunCode& code, ByteBuffer& out);

    /// Adds the next rows, from the top (see RowSink).
    void add(std::span<const PixelRun> row, std::uint32_t times);
    /// Ends the image; must be called after the last row.
    void finish();
    /// Returns the number of pixels so far whose value in runs is not 0.
    [[nodiscard]] std::uint64_t lit() const noexcept { return lit_; }

  private:
    void add(std::uint8_t value, std::uint64_t pixels) {
        if (value != value_) {
            put();
            value_ = value;
            length_ = 0;
        }
        length_ += pixels;
    }
    void put();

    const RunCode& code_;
    ByteBuffer& out_;
    std::size_t begin_; ///< position of the image in out_
    std::uint8_t value_ = 0;
    std::uint64_t length_ = 0;
    std::uint64_t lit_ = 0;
};

} // namespace lamella
