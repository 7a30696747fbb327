#pragma once

// Layers as PNG files, in memory.

#include "lamella/contour/layer.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/raster/image.hpp"

#include "container/byte_buffer.hpp"
#include "container/zip_writer.hpp"
#include "slices/images/png.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace lamella {

struct LayerImage {
    std::shared_ptr<const ByteBuffer> file;
    std::uint32_t crc = 0; ///< of the file
    RasterAreas areas = {};

    [[nodiscard]] ZipChunk in_zip() const { return {file->view(), file->view().size(), crc}; }
};

/// Returns the material that the image of a layer at z does not show because it is too thin for the pixels.
/// Corners and the edges of bodies lose a little everywhere, so the count is 0 unless the layer loses more
/// than a thousandth of its area, and more than a pixel.
[[nodiscard]] Finding unseen_material(double z, const RasterAreas& areas, double pixel_mm2);

/// Draws all parts into one image, like `rasterise`. Holes without an outer ring are not drawn.
RasterAreas draw_parts(std::span<const Layer> all, const PixelGrid& grid, RasterOptions options,
                       const RowSink& sink);

/// Draws planes with the same grid and options: from their images if they have one, otherwise from their cuts
/// if they have some, and otherwise from their contours. The mean of cuts becomes a value as a covered part
/// does. May be used by any number of threads at once.
class PlaneDrawing {
  public:
    /// `images` is the grid of the images of planes. It is mirrored if `grid` is, and equal otherwise.
    PlaneDrawing(const PixelGrid& grid, const RasterOptions& options, const std::optional<PixelGrid>& images);

    RasterAreas draw(const Plane& plane, const RowSink& sink) const;

    [[nodiscard]] const PixelGrid& grid() const noexcept { return grid_; }
    [[nodiscard]] const RasterOptions& options() const noexcept { return options_; }

  private:
    RasterAreas draw_image(const RunImage& image, const RowSink& sink) const;
    RasterAreas draw_mean(std::span<const std::vector<Layer>> cuts, const RowSink& sink) const;

    PixelGrid grid_;
    RasterOptions options_;
    bool mirror_columns_ = false; ///< of images
    bool mirror_rows_ = false;
};

/// Draws the number of the part, from 1 on, in which the centre of each pixel lies; 0 outside of all. If it
/// lies in several, the part that covers most of the pixel counts, and the first among equals. There may be
/// 255 parts.
RasterAreas draw_part_numbers(std::span<const Layer> parts, const PixelGrid& grid, const RowSink& sink);

/// Makes images with the same grid and options. With a palette, pixels are numbers of parts. May be used by
/// any number of threads at once.
class LayerImages {
  public:
    explicit LayerImages(const PlaneDrawing& drawing, PngPixels pixels = {});

    /// Draws all parts into one image.
    [[nodiscard]] LayerImage image(const Plane& plane) const;

    [[nodiscard]] const PixelGrid& grid() const noexcept { return drawing_.grid(); }
    [[nodiscard]] const RasterOptions& options() const noexcept { return drawing_.options(); }
    [[nodiscard]] const PngPixels& pixels() const noexcept { return pixels_; }

  private:
    PlaneDrawing drawing_;
    PngPixels pixels_;
    std::shared_ptr<BufferPool> buffers_ = std::make_shared<BufferPool>();
};

} // namespace lamella
