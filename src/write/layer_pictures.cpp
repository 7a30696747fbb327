#include "write/layer_pictures.hpp"

#include "lamella/polygon/fill.hpp"

#include "container/inflate.hpp"
#include "write/png.hpp"

#include <algorithm>
#include <vector>

namespace lamella {

namespace {

/// Where contours are open, the outer one of a hole may be among them: alone, the hole would be drawn as a
/// body.
Layer without_lone_holes(const Layer& layer) {
    return layer.open_chains() > 0 ? fill(layer, FillRule::positive).layer : layer;
}

} // namespace

// Options that make no picture show before the first layer does.
LayerPictures::LayerPictures(const PixelGrid& grid, const RasterOptions& options)
    : grid_(grid), options_(options) {
    static_cast<void>(picture({}));
}

LayerPicture LayerPictures::picture(std::span<const Layer> all) const {
    std::vector<Layer> parts(all.size());
    std::transform(all.begin(), all.end(), parts.begin(), without_lone_holes);
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
