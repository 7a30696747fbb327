#include "slices/images/layer_images.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/fill.hpp"

#include "container/inflate.hpp"
#include "contour/box2.hpp"
#include "raster/grey_values.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <numeric>
#include <utility>
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

namespace {

/// Visits the rows of an image from one of its ends to the other.
class ImageRows {
  public:
    ImageRows(const RunImage& image, bool mirror_columns) : image_(image), mirror_columns_(mirror_columns) {}

    /// Returns the runs of a row, which are valid until the next call.
    [[nodiscard]] std::span<const PixelRun> row(std::uint32_t r) {
        const std::uint64_t begin = std::uint64_t{r} * image_.width;
        const std::uint64_t end = begin + image_.width;
        while (at_ > 0 && image_.runs[at_ - 1].end > begin)
            --at_;
        while (image_.runs[at_].end <= begin)
            ++at_;
        runs_.clear();
        for (std::size_t i = at_; runs_.empty() || runs_.back().end < image_.width; ++i)
            runs_.push_back({static_cast<std::uint32_t>(std::min(image_.runs[i].end, end) - begin),
                             image_.runs[i].value});
        if (mirror_columns_)
            mirror();
        return runs_;
    }

  private:
    void mirror() {
        std::reverse(runs_.begin(), runs_.end());
        for (std::size_t i = 0; i < runs_.size(); ++i) // the run that now follows ended where this one began
            runs_[i].end = image_.width - (i + 1 < runs_.size() ? runs_[i + 1].end : 0);
    }

    const RunImage& image_;
    bool mirror_columns_;
    std::size_t at_ = 0; ///< a run of the last row
    std::vector<PixelRun> runs_;
};

/// Makes a row black and white.
void make_black_and_white(std::vector<PixelRun>& row) {
    std::size_t kept = 0;
    for (const PixelRun& run : row) {
        const std::uint8_t value = run.value >= 128 ? 255 : 0;
        if (kept > 0 && row[kept - 1].value == value)
            row[kept - 1].end = run.end;
        else
            row[kept++] = {run.end, value};
    }
    row.resize(kept);
}

void append_run(std::vector<ImageRun>& runs, ImageRun run) {
    if (!runs.empty() && runs.back().value == run.value)
        runs.back().end = run.end;
    else
        runs.push_back(run);
}

/// Appends `times` equal rows to the runs of an image.
void append_rows(std::vector<ImageRun>& runs, std::span<const PixelRun> row, std::uint32_t times,
                 std::uint32_t width) {
    const std::uint64_t first = runs.empty() ? 0 : runs.back().end;
    if (row.size() == 1) {
        append_run(runs, {first + std::uint64_t{times} * width, row.front().value});
        return;
    }
    for (std::uint32_t i = 0; i < times; ++i)
        for (const PixelRun& run : row)
            append_run(runs, {first + std::uint64_t{i} * width + run.end, run.value});
}

/// Returns an image of the size of others, whose pixels have the value of value_of(pixels of the others).
template <class ValueOf>
RunImage merged_images(std::span<const RunImage> images, const ValueOf& value_of) {
    RunImage made{images.front().width, images.front().height, {}};
    std::vector<std::size_t> at(images.size()); // the run of each image that contains the next pixel
    std::vector<std::uint8_t> values(images.size());
    for (std::uint64_t pixel = 0; pixel < made.pixels();) {
        std::uint64_t end = made.pixels();
        for (std::size_t i = 0; i < images.size(); ++i) {
            const ImageRun& run = images[i].runs[at[i]];
            end = std::min(end, run.end);
            values[i] = run.value;
        }
        append_run(made.runs, {end, value_of(values)});
        for (std::size_t i = 0; i < images.size(); ++i)
            at[i] += images[i].runs[at[i]].end == end ? 1 : 0;
        pixel = end;
    }
    return made;
}

/// Returns the mean of images of the same size, with these values for means in steps of 1/255.
RunImage mean_of(std::span<const RunImage> images, const GreyValues& values) {
    return merged_images(images, [&values](std::span<const std::uint8_t> pixels) {
        const auto count = static_cast<std::uint32_t>(pixels.size());
        const std::uint32_t sum = std::accumulate(pixels.begin(), pixels.end(), std::uint32_t{0});
        return values[(sum + count / 2) / count];
    });
}

/// Returns the image of some parts.
RunImage drawn(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options,
               RasterAreas& areas) {
    RunImage image{grid.width, grid.height, {}};
    areas = draw_parts(parts, grid, options,
                       [&image](auto row, auto times) { append_rows(image.runs, row, times, image.width); });
    return image;
}

/// Returns the coverage of those pixels whose centres are in the part, which are not 0 in `centres`.
RunImage shares_of(RunImage centres, const Layer& part, const PixelGrid& grid) {
    RasterAreas areas;
    std::vector<RunImage> both;
    both.push_back(std::move(centres));
    both.push_back(drawn({&part, 1}, grid, {.antialias = most_antialias}, areas));
    return merged_images(both, [](std::span<const std::uint8_t> pixels) -> std::uint8_t {
        return pixels[0] > 0 ? std::max<std::uint8_t>(pixels[1], 1) : 0;
    });
}

double value_of(std::span<const PixelRun> row) {
    std::uint64_t sum = 0;
    std::uint32_t from = 0;
    for (const PixelRun& run : row) {
        sum += std::uint64_t{run.end - from} * run.value;
        from = run.end;
    }
    return static_cast<double>(sum) / 255;
}

} // namespace

PlaneDrawing::PlaneDrawing(const PixelGrid& grid, const RasterOptions& options,
                           const std::optional<PixelGrid>& images)
    : grid_(grid), options_(options),
      mirror_columns_(images && (images->ux != grid.ux || images->uy != grid.uy)),
      mirror_rows_(images && (images->vx != grid.vx || images->vy != grid.vy)) {}

RasterAreas PlaneDrawing::draw(const Plane& plane, const RowSink& sink) const {
    if (plane.image)
        return draw_image(*plane.image, sink);
    return plane.cuts.empty() ? draw_parts(plane.polylines, grid_, options_, sink)
                              : draw_mean(plane.cuts, sink);
}

RasterAreas PlaneDrawing::draw_mean(std::span<const std::vector<Layer>> cuts, const RowSink& sink) const {
    RasterOptions linear = options_; // the values of cuts are their coverage
    linear.gamma = 1;
    linear.grey_values.reset();
    RasterAreas mean;
    std::vector<RunImage> images;
    const double share = 1 / static_cast<double>(cuts.size());
    for (const std::vector<Layer>& cut : cuts) {
        RasterAreas areas;
        images.push_back(drawn(cut, grid_, linear, areas));
        mean.covered += share * areas.covered;
        mean.unseen += share * areas.unseen;
    }
    static_cast<void>(draw_image(mean_of(images, values_of(options_)), sink));
    return mean;
}

RasterAreas PlaneDrawing::draw_image(const RunImage& image, const RowSink& sink) const {
    assert(image.width == grid_.width && image.height == grid_.height);
    ImageRows rows(image, mirror_columns_);
    RasterAreas areas;
    std::vector<PixelRun> same; // the last rows, which are equal
    std::uint32_t times = 0;
    std::vector<PixelRun> row;
    for (std::uint32_t r = 0; r < image.height; ++r) {
        const std::span<const PixelRun> runs = rows.row(mirror_rows_ ? image.height - 1 - r : r);
        row.assign(runs.begin(), runs.end());
        if (options_.antialias == 1)
            make_black_and_white(row);
        areas.covered += value_of(row);
        if (times > 0 && row != same) {
            sink(same, times);
            times = 0;
        }
        std::swap(row, same);
        ++times;
    }
    sink(same, times);
    return areas;
}

RasterAreas draw_part_numbers(std::span<const Layer> parts, const PixelGrid& grid, const RowSink& sink) {
    const PlaneDrawing drawing(grid, {}, {});
    std::vector<RunImage> images;
    std::vector<std::uint8_t> numbers;
    RasterAreas all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].rings == 0)
            continue;
        RasterAreas areas;
        images.push_back(drawn(parts.subspan(i, 1), grid, {.antialias = 1}, areas));
        numbers.push_back(static_cast<std::uint8_t>(i + 1));
        all.unseen += areas.unseen;
    }
    if (images.empty())
        return drawing.draw(Plane(), sink);
    bool overlap = false;
    const auto number_of = [&](std::span<const std::uint8_t> pixels) -> std::uint8_t {
        const auto most = std::max_element(pixels.begin(), pixels.end());
        overlap =
            overlap || std::any_of(most + 1, pixels.end(), [](std::uint8_t value) { return value > 0; });
        return *most == 0 ? 0 : numbers[static_cast<std::size_t>(most - pixels.begin())];
    };
    RunImage numbered = merged_images(images, number_of);
    if (overlap) { // exact coverage decides
        for (std::size_t i = 0; i < images.size(); ++i)
            images[i] = shares_of(std::move(images[i]), parts[numbers[i] - 1U], grid);
        numbered = merged_images(images, number_of);
    }
    Plane plane;
    plane.image = std::make_shared<RunImage>(numbered);
    drawing.draw(plane, [&](std::span<const PixelRun> row, std::uint32_t times) {
        std::uint32_t from = 0;
        for (const PixelRun& run : row) {
            if (run.value > 0)
                all.covered += static_cast<double>(run.end - from) * times;
            from = run.end;
        }
        sink(row, times);
    });
    return all;
}

// Draws an empty image so that impossible options are reported before the first layer.
LayerImages::LayerImages(const PlaneDrawing& drawing, PngPixels pixels)
    : drawing_(drawing), pixels_(std::move(pixels)) {
    static_cast<void>(image(Plane()));
}

LayerImage LayerImages::image(const Plane& plane) const {
    PngEncoder encoder(grid().width, grid().height, pixels_);
    const RowSink encode = [&](auto row, auto times) {
        encoder.add(row, times);
    };
    const RasterAreas areas = pixels_.palette.empty() ? drawing_.draw(plane, encode)
                                                      : draw_part_numbers(plane.polylines, grid(), encode);
    const std::shared_ptr<ByteBuffer> file = buffers_->take();
    encoder.finish(*file);
    return {file, crc32_of(file->view()), areas};
}

} // namespace lamella
