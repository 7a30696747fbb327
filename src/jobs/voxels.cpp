#include "lamella/jobs/voxels.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/raster/image.hpp"

#include "core/byte_amount.hpp"
#include "core/executor.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

namespace lamella {
namespace {

/// Half of a pixel or more, as a value.
constexpr std::uint8_t half_covered = 128;

double height_of(const VoxelGrid& grid, std::uint32_t layer) {
    return grid.origin.z + layer * grid.spacing.z;
}

void check_counts(const VoxelGrid& grid) {
    for (const std::uint32_t side : {grid.columns, grid.rows})
        if (side < 1 || side > most_pixels)
            throw Error(ErrorKind::usage,
                        fmt::format("an array of {} x {} x {} voxels: along x and y there must be 1 to {}",
                                    grid.columns, grid.rows, grid.layers, most_pixels));
    if (grid.layers > max_layers)
        throw Error(ErrorKind::usage, fmt::format("an array of {} x {} x {} voxels: along z there may be {}",
                                                  grid.columns, grid.rows, grid.layers, max_layers));
}

void check_positions(const VoxelGrid& grid) {
    const Point3& first = grid.origin;
    const Point3& step = grid.spacing;
    for (const double size : {step.x, step.y, step.z})
        if (!(size > 0) || !std::isfinite(size) || !std::isfinite(1 / size))
            throw Error(ErrorKind::usage,
                        fmt::format("a voxel of {} x {} x {} mm: each side must be above 0 and finite",
                                    step.x, step.y, step.z));
    for (const double place :
         {first.x, first.y, first.z, first.x / step.x, first.y / step.y, first.z + step.z * grid.layers})
        if (!std::isfinite(place))
            throw Error(ErrorKind::usage, "the voxels lie where coordinates are no finite numbers");
    // Rounding is largest at the end that is farthest from 0.
    const std::uint32_t last = std::max(grid.layers, 2U) - 1;
    if (!(height_of(grid, 0) < height_of(grid, 1)) || !(height_of(grid, last - 1) < height_of(grid, last)))
        throw Error(ErrorKind::usage,
                    fmt::format("voxels {} mm high at z = {} mm are too low for double precision", step.z,
                                std::abs(first.z) > std::abs(height_of(grid, last)) ? first.z
                                                                                    : height_of(grid, last)));
}

void check_array(const VoxelGrid& grid, std::size_t size) {
    check_counts(grid);
    check_positions(grid);
    if (size != grid.size())
        throw Error(ErrorKind::usage, fmt::format("an array of {} numbers is no array of {} x {} x {} voxels",
                                                  size, grid.columns, grid.rows, grid.layers));
}

/// Returns the map to the pixels of a layer. Row 0 is that of the smallest y.
PixelGrid pixels_of(const VoxelGrid& grid) {
    return {.width = grid.columns,
            .height = grid.rows,
            .ux = 1 / grid.spacing.x,
            .u0 = 0.5 - grid.origin.x / grid.spacing.x,
            .vy = 1 / grid.spacing.y,
            .v0 = 0.5 - grid.origin.y / grid.spacing.y};
}

Plan plan_of(const VoxelGrid& grid) {
    Plan plan;
    plan.layers.reserve(grid.layers);
    for (std::uint32_t k = 0; k < grid.layers; ++k) {
        const double z = height_of(grid, k);
        plan.layers.push_back(
            {.index = k, .z = z, .bottom = z - grid.spacing.z / 2, .top = z + grid.spacing.z / 2});
    }
    return plan;
}

/// Returns the layers without holes that would be drawn as bodies, because their outer contours are open.
std::vector<Layer> without_lone_holes(std::span<const Layer> layers, const LayerLimits& limits) {
    std::vector<Layer> parts(layers.begin(), layers.end());
    for (Layer& part : parts)
        if (part.open_chains() > 0 && part.rings > 0)
            part = fill(part, FillRule::positive, limits).layer;
    return parts;
}

/// Calls run(first, end, value) for all runs of pixels, by their numbers in the image.
template <class Run>
void draw(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options, const Run& run) {
    std::size_t begin = 0; // of the row
    rasterise(parts, grid, options, [&](std::span<const PixelRun> row, std::uint32_t times) {
        for (std::uint32_t i = 0; i < times; ++i, begin += grid.width) {
            std::size_t first = begin;
            for (const PixelRun& pixels : row)
                run(std::exchange(first, begin + pixels.end), begin + pixels.end, pixels.value);
        }
    });
}

RasterOptions exact(std::span<const Layer> parts) {
    return {.antialias = most_antialias, .winds_once = winds_once(parts)};
}

void write_pixels(std::span<const Layer> layers, const PixelGrid& grid, PixelValue value,
                  const LayerLimits& limits, std::span<std::uint8_t> pixels) {
    const std::vector<Layer> parts = without_lone_holes(layers, limits);
    const bool covers = value == PixelValue::coverage;
    // Drawing without grey values gives 0 and 255.
    const std::uint8_t most = covers ? 255 : 1;
    draw(parts, grid, covers ? exact(parts) : RasterOptions{.antialias = 1},
         [&](std::size_t first, std::size_t end, std::uint8_t of_run) {
             std::fill(pixels.begin() + static_cast<std::ptrdiff_t>(first),
                       pixels.begin() + static_cast<std::ptrdiff_t>(end), std::min(of_run, most));
         });
}

template <class Label>
void write_labels(std::span<const Layer> layers, const PixelGrid& grid, const LayerLimits& limits,
                  std::span<Label> labels) {
    const std::vector<Layer> parts = without_lone_holes(layers, limits);
    std::fill(labels.begin(), labels.end(), Label{0});
    std::vector<std::size_t> present;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].rings > 0)
            present.push_back(i);
    // The largest coverage by a part. A single part needs no comparison.
    std::vector<std::uint8_t> largest(present.size() > 1 ? labels.size() : 0);
    for (const std::size_t i : present) {
        const std::span<const Layer> part(&parts[i], 1);
        const auto number = static_cast<Label>(i + 1);
        draw(part, grid, exact(part), [&](std::size_t first, std::size_t end, std::uint8_t value) {
            if (largest.empty()) {
                if (value >= half_covered)
                    std::fill(labels.begin() + static_cast<std::ptrdiff_t>(first),
                              labels.begin() + static_cast<std::ptrdiff_t>(end), number);
                return;
            }
            for (std::size_t pixel = first; value > 0 && pixel < end; ++pixel)
                if (value > largest[pixel]) {
                    largest[pixel] = value;
                    labels[pixel] = number;
                }
        });
    }
    if (largest.empty())
        return;
    draw(parts, grid, exact(parts), [&](std::size_t first, std::size_t end, std::uint8_t value) {
        if (value < half_covered)
            std::fill(labels.begin() + static_cast<std::ptrdiff_t>(first),
                      labels.begin() + static_cast<std::ptrdiff_t>(end), Label{0});
    });
}

/// Returns the limits of the work on a plane, if each thread works on one.
LayerLimits limits_of_planes(const Execution& execution) {
    return layer_limits(execution, memory_limit(0), thread_count(execution));
}

/// Calls write(parts, limits, values) for the parts on each layer of the grid, with the values of its voxels,
/// while slicing. Returns the defects of the layers.
template <class Value, class Write>
Findings fill_layers(const Plate& plate, const VoxelGrid& grid, std::span<Value> values,
                     const Execution& execution, const Write& write) {
    check_array(grid, values.size());
    if (grid.layers == 0)
        return {};
    std::deque<LayerFindingSearch> searches; // of each file
    for (std::size_t file = 0; file < plate.files.size(); ++file)
        searches.emplace_back(grid.layers, LayerUse::cut, Rounding{}, InversionSearch::quick, execution);
    const LayerLimits limits = limits_of_planes(execution);
    const auto size = static_cast<std::size_t>(grid.layer_size());
    const PlateSink sink{.prepare = [&](const Plane& bodies) {
        const PlateMaterial material = material_of(bodies.polylines, plate.negatives, {}, limits);
        const auto position = static_cast<std::size_t>(bodies.polylines.front().index);
        for (std::size_t part = 0; part < material.parts.size(); ++part)
            searches[plate.shapes[plate.parts[part].shape].input].look_at(position, part,
                                                                          material.parts[part]);
        write(material.parts, limits, values.subspan(position * size, size));
        return Commit();
    }};
    static_cast<void>(slice_to(sink, plate, plan_of(grid), {.execution = execution}));
    Findings findings;
    for (std::size_t file = 0; file < searches.size(); ++file)
        for (Finding finding : searches[file].findings().by_file) {
            finding.file = static_cast<std::uint32_t>(file);
            findings.add(std::move(finding));
        }
    return findings;
}

template <class Label>
Findings fill_with_labels(const Plate& plate, const VoxelGrid& grid, std::span<Label> labels,
                          const Execution& execution) {
    constexpr std::size_t most = std::numeric_limits<Label>::max();
    if (plate.parts.size() > most)
        throw Error(ErrorKind::usage,
                    fmt::format("{} parts cannot be numbered by {} numbers", plate.parts.size(), most));
    return fill_layers(
        plate, grid, labels, execution,
        [map = pixels_of(grid)](std::span<const Layer> parts, const LayerLimits& limits,
                                std::span<Label> layer) { write_labels(parts, map, limits, layer); });
}

} // namespace

void check(const VoxelGrid& grid, std::uint64_t bytes, std::uint64_t max_memory) {
    check_counts(grid);
    check_positions(grid);
    const std::uint64_t limit =
        std::min<std::uint64_t>(memory_limit(max_memory), std::numeric_limits<std::ptrdiff_t>::max());
    if (grid.size() > limit / bytes)
        throw Error(ErrorKind::limit,
                    fmt::format("an array of {} x {} x {} voxels takes {} of memory, above the {} {}; choose "
                                "larger voxels, or a part of the space",
                                grid.columns, grid.rows, grid.layers,
                                byte_amount(grid.size() > std::numeric_limits<std::uint64_t>::max() / bytes
                                                ? std::numeric_limits<std::uint64_t>::max()
                                                : grid.size() * bytes),
                                byte_amount(limit),
                                max_memory != 0 ? "of `max_memory`" : "that may be taken"));
}

void fill_pixels(const PlaneSource& source, const VoxelGrid& grid, PixelValue value,
                 std::span<std::uint8_t> pixels, const Execution& execution) {
    check_array(grid, pixels.size());
    if (source.planes.size() != grid.layers)
        throw Error(ErrorKind::usage,
                    fmt::format("{} planes are no array of {} layers", source.planes.size(), grid.layers));
    const PixelGrid map = pixels_of(grid);
    const LayerLimits limits = limits_of_planes(execution);
    const auto size = static_cast<std::size_t>(grid.layer_size());
    source.visit(
        Stage::polygon,
        [&](std::size_t i, const Plane& plane, unsigned) {
            write_pixels(plane.polylines, map, value, limits, pixels.subspan(i * size, size));
        },
        execution);
}

Findings fill_coverage(const Plate& plate, const VoxelGrid& grid, std::span<std::uint8_t> coverage,
                       const Execution& execution) {
    return fill_layers(plate, grid, coverage, execution,
                       [map = pixels_of(grid)](std::span<const Layer> parts, const LayerLimits& limits,
                                               std::span<std::uint8_t> layer) {
                           write_pixels(parts, map, PixelValue::coverage, limits, layer);
                       });
}

Findings fill_labels(const Plate& plate, const VoxelGrid& grid, std::span<std::uint8_t> labels,
                     const Execution& execution) {
    return fill_with_labels(plate, grid, labels, execution);
}

Findings fill_labels(const Plate& plate, const VoxelGrid& grid, std::span<std::uint16_t> labels,
                     const Execution& execution) {
    return fill_with_labels(plate, grid, labels, execution);
}

} // namespace lamella
