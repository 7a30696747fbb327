#include "write/layer_pictures.hpp"

#include "lamella/polygon/fill.hpp"

#include "container/inflate.hpp"
#include "write/png.hpp"

namespace lamella {

// Options that make no picture show before the first layer does.
LayerPictures::LayerPictures(const PixelGrid& grid, const RasterOptions& options)
    : grid_(grid), options_(options) {
    static_cast<void>(picture({}));
}

LayerPicture LayerPictures::picture(std::span<const Layer> parts) const {
    RasterOptions options = options_;
    // To look takes less than drawing, and contours finer than pixels are drawn in a fraction of the time
    // then.
    options.winds_once = options.antialias > 1 && winds_once(parts);
    PngEncoder encoder(grid_.width, grid_.height);
    const double covered =
        rasterise(parts, grid_, options, [&](auto row, auto times) { encoder.add(row, times); });
    const std::shared_ptr<ByteBuffer> file = buffers_->take();
    encoder.finish(*file);
    return {file, crc32_of(file->view()), covered};
}

} // namespace lamella
