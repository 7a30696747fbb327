#pragma once

// Base of the readers of files with an image for each layer.
//
// A format reads its head and its index of layers, and decodes the image of a layer. The limits, threads,
// heights, outlines and findings are the same for all of them.

#include "lamella/contour/run_image.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/resin_job.hpp"
#include "lamella/slices/resin_printer.hpp"

#include "container/read_limits.hpp"
#include "raster/outlines.hpp"
#include "slices/images/run_builder.hpp"
#include "slices/images/run_codes.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The head of a file and its index of layers.
struct ImageStackHead {
    std::string format = {}; ///< as in LayerFile
    PixelGrid grid = {};
    ResinJob job = {};
    std::vector<double> tops_mm = {}; ///< of layers that lie on one another, the first of them at 0
    std::vector<Layer> planes = {};   ///< or all heights of the layers
    std::vector<std::string> warnings = {};
    /// The value from which on pixels count as material. With several images in black and white, half of them
    /// give 127.
    std::uint8_t bright_from = lamella::bright_from;
    /// True if the first image may lack its last pixel, which is then black.
    bool may_lack_pixel = false;
};

inline constexpr std::uint8_t bright_from_of_sets = 127;

/// The images of an opened file.
class ImageStack {
  public:
    ImageStack() = default;
    ImageStack(const ImageStack&) = delete;
    ImageStack& operator=(const ImageStack&) = delete;
    virtual ~ImageStack() = default;

    /// Decodes the image of a layer. May be called from any threads. Throws Error{input}, which names the
    /// layer and the byte.
    virtual void decode(std::size_t layer, RunBuilder& image, ReadLimits& limits) const = 0;
    /// Returns the place of the image of a layer, for errors, such as "byte 195547".
    [[nodiscard]] virtual std::string place(std::size_t layer) const = 0;
    /// Returns the bytes that decoding takes besides the runs.
    [[nodiscard]] virtual std::uint64_t decoding_bytes() const { return 0; }
};

/// Where the code of an image stands in a file, for errors.
struct CodePlace {
    const std::string& name; ///< of the file
    std::size_t layer;
    std::uint64_t offset;
};

/// Decodes the code of the image of a layer. Throws Error{input} that names the layer and the byte.
void decode_layer(DecodeRuns& decode, std::string_view code, const CodePlace& place, RunBuilder& image);

/// Returns one of the images in black and white of a layer. Throws Error{input} unless it is complete.
[[nodiscard]] RunImage whole_set(RunBuilder& set, const CodePlace& place);

/// Returns the value of a pixel that is white in some of these images.
[[nodiscard]] constexpr std::uint8_t grey_of_sets(std::size_t white, std::size_t sets) noexcept {
    return static_cast<std::uint8_t>(white == 0 ? 0 : white * 256 / sets - 1);
}

/// Adds up such images.
void add_sets(std::span<const RunImage> sets, RunBuilder& image);

/// Decodes as many such images from one code, in which they follow one another, and adds them up.
void decode_bit_sets(std::string_view code, std::uint32_t sets, const CodePlace& place, RunBuilder& image,
                     ReadLimits& limits);

/// Returns the printer of this name, in any case of letters, or null. Its mirroring is that of files that do
/// not say.
[[nodiscard]] const ResinPrinter* known_printer(std::string_view name) noexcept;

/// Returns the grid of a display with the middle of the display at (0, 0). Throws Error{input} unless there
/// are 1 to `most_pixels` pixels along each side. If the size of the display is not known, pixels are 0.05 mm
/// wide.
[[nodiscard]] PixelGrid grid_of_display(const std::string& name, AlongXY<std::uint32_t> pixels,
                                        AlongXY<double> display_mm, bool mirror_x, bool mirror_y);

/// Throws Error{input} unless a file of this size can have this many layers, each of which takes at least
/// some bytes.
void check_layer_count(const std::string& name, std::uint64_t at, std::uint64_t layers, std::uint64_t each,
                       std::uint64_t bytes);

/// Returns the file. Decodes all images once, on all threads, and again when planes are made. The limits must
/// live as long as the result.
[[nodiscard]] LayerFile read_images(ImageStackHead head, std::shared_ptr<const ImageStack> stack,
                                    const std::string& name, ReadLimits& limits, const Execution& execution);

} // namespace lamella
