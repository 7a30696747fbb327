#include "slices/images/layer_images.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/fill.hpp"

#include "container/inflate.hpp"
#include "contour/box2.hpp"
#include "slices/images/png.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lamella {

namespace {

/// Returns whether the outer contour of a hole may be among the open chains.
bool may_have_lone_holes(const Layer& layer) {
    if (layer.open_chains() == 0)
        return false;
    Box2 open = box_of(layer.contour(layer.rings));
    for (std::size_t i = layer.rings + 1; i < layer.contours(); ++i)
        open.add(box_of(layer.contour(i)));
    for (std::size_t i = 0; i < layer.rings; ++i)
        if (const Box2 box = box_of(layer.contour(i)); ring_area(layer.contour(i)) < 0 && open.x0 <= box.x0 &&
                                                       box.x1 <= open.x1 && open.y0 <= box.y0 &&
                                                       box.y1 <= open.y1)
            return true;
    return false;
}

/// Removes holes without an outer ring, which would be drawn as solid.
Layer without_lone_holes(const Layer& layer) {
    return may_have_lone_holes(layer) ? fill(layer, FillRule::positive).layer : layer;
}

} // namespace

Finding unseen_material(double z, const RasterAreas& areas, double pixel_mm2) {
    const bool seen = areas.unseen <= 1 || areas.unseen <= 1e-3 * (areas.covered + areas.unseen);
    if (seen)
        return {.kind = FindingKind::unseen_material};
    return {.kind = FindingKind::unseen_material,
            .count = 1,
            .amount = areas.unseen * pixel_mm2,
            .layers = 1,
            .first_z = z};
}

RasterAreas draw_parts(std::span<const Layer> all, const PixelGrid& grid, RasterOptions options,
                       const RowSink& sink) {
    std::vector<Layer> parts(all.size());
    std::transform(all.begin(), all.end(), parts.begin(), without_lone_holes);
    // This check takes less time than drawing. If it succeeds, contours finer than pixels are drawn in a
    // fraction of the time.
    options.winds_once = options.antialias > 1 && winds_once(parts);
    return rasterise(parts, grid, options, sink);
}

// Draws an empty image so that impossible options are reported before the first layer.
LayerImages::LayerImages(const PixelGrid& grid, const RasterOptions& options)
    : grid_(grid), options_(options) {
    static_cast<void>(image({}));
}

LayerImage LayerImages::image(std::span<const Layer> all) const {
    PngEncoder encoder(grid_.width, grid_.height);
    const RasterAreas areas =
        draw_parts(all, grid_, options_, [&](auto row, auto times) { encoder.add(row, times); });
    const std::shared_ptr<ByteBuffer> file = buffers_->take();
    encoder.finish(*file);
    return {file, crc32_of(file->view()), areas};
}

} // namespace lamella
