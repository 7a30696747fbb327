#include "lamella/raster/image.hpp"

#include "lamella/core/error.hpp"

#include "raster/centres.hpp"
#include "raster/coverage.hpp"
#include "raster/drawn_row.hpp"
#include "raster/grey_values.hpp"
#include "raster/summed_coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace lamella {

namespace {

void check(const PixelGrid& grid, const RasterOptions& options) {
    if (grid.width < 1 || grid.height < 1 || grid.width > most_pixels || grid.height > most_pixels)
        throw Error(ErrorKind::usage, fmt::format("an image of {} x {} pixels: each side must have 1 to {}",
                                                  grid.width, grid.height, most_pixels));
    const std::array map{grid.ux, grid.uy, grid.u0, grid.vx, grid.vy, grid.v0};
    const double scale = grid.ux * grid.vy - grid.uy * grid.vx;
    if (!std::all_of(map.begin(), map.end(), [](double v) { return std::isfinite(v); }) ||
        !std::isfinite(scale) || scale == 0)
        throw Error(ErrorKind::usage, "the pixels of an image must have a size that is finite and not zero");
    if (options.antialias < 1 || options.antialias > most_antialias)
        throw Error(ErrorKind::usage, fmt::format("anti-aliasing of level {}: choose 1 (none) to {}",
                                                  options.antialias, most_antialias));
    check_grey(options);
}

template <class Rows>
RasterAreas draw(Rows rows, std::uint32_t height, const RowSink& sink) {
    RasterAreas areas{.covered = 0, .unseen = rows.between_rows()};
    std::vector<PixelRun> same; // the last rows, which are equal
    std::uint32_t times = 0;
    for (std::uint32_t row = 0; row < height;) {
        const DrawnRow drawn = rows.draw(row);
        assert(drawn.times >= 1 && drawn.times <= height - row);
        assert(!drawn.runs.empty());
        areas.covered += drawn.covered * drawn.times;
        areas.unseen += drawn.unseen;
        if (times > 0 && !std::equal(same.begin(), same.end(), drawn.runs.begin(), drawn.runs.end())) {
            sink(same, times);
            times = 0;
        }
        if (times == 0)
            same.assign(drawn.runs.begin(), drawn.runs.end());
        times += drawn.times;
        row += drawn.times;
    }
    sink(same, times);
    return areas;
}

} // namespace

RasterAreas rasterise(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options,
                      const RowSink& sink) {
    check(grid, options);
    if (options.antialias == 1)
        return draw(CentreRows(parts, grid), grid.height, sink);
    if (options.winds_once)
        return draw(SummedRows(parts, grid, values_of(options)), grid.height, sink);
    return draw(CoverageRows(parts, grid, options), grid.height, sink);
}

GreyImage paint(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options) {
    check(grid, options);
    GreyImage image{grid.width, grid.height, {}};
    image.values.resize(std::size_t{grid.width} * grid.height);
    std::uint8_t* out = image.values.data();
    rasterise(parts, grid, options, [&](std::span<const PixelRun> row, std::uint32_t times) {
        std::uint32_t from = 0;
        for (const PixelRun& run : row) {
            std::memset(out + from, run.value, run.end - from);
            from = run.end;
        }
        assert(from == grid.width);
        for (std::uint32_t i = 1; i < times; ++i)
            std::memcpy(out + std::size_t{i} * grid.width, out, grid.width);
        out += std::size_t{times} * grid.width;
    });
    assert(out == image.values.data() + image.values.size());
    return image;
}

} // namespace lamella
