// Measures the cost of images: for a job with images of 2560 x 1620 pixels, the CPU seconds of slicing, the
// raster, the image files, and the whole job from an STL file, compared with touching every pixel once
// (memset). The covered areas are compared with those of the sections.
//
// Each row is measured a given number of times, or as often as the seconds allow.

#include "experiment.hpp"
#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>

namespace lamella::bench {

namespace {

constexpr std::uint32_t width = 2560;
constexpr std::uint32_t height = 1620;

/// Returns the smallest size of square pixels with which the part fits on the display.
double pixel_mm(const Box3& box) {
    return std::max((box.max.x - box.min.x) / width, (box.max.y - box.min.y) / height);
}

ImageOptions images(const Box3& box, unsigned antialias) {
    const double mm = pixel_mm(box);
    return {.pixel_mm = {{mm, mm}},
            .pixels = {{width, height}},
            .portrait = false,
            .raster = {.antialias = antialias}};
}

std::unique_ptr<LayerWriter> open_job(const OpenedPart& opened, const std::string& path, unsigned antialias) {
    return open_layer_writer(
        path, layer_format("sl1s", ""),
        {.box = opened.box, .layers = opened.plan.layers.size(), .bottom = opened.plan.layers.front().bottom},
        {.image = images(opened.box, antialias)});
}

/// Slices the STL file into a job, on all threads.
void into_job(const Part& part, const std::string& path, unsigned antialias) {
    const OpenedPart opened = open_part(part, {});
    const auto writer = open_job(opened, path, antialias);
    slice_to({.prepare =
                  [&](Layer&& layer) {
                      return writer->prepare(layer);
                  }},
             opened.mesh, opened.plan);
    writer->finish();
}

PixelGrid grid_of(const Box3& box) {
    const double mm = pixel_mm(box);
    return {.width = width,
            .height = height,
            .ux = 1 / mm,
            .u0 = -box.min.x / mm,
            .vy = 1 / mm,
            .v0 = -box.min.y / mm};
}

/// Options as in the writers of images.
RasterOptions raster_options(const Layer& layer, unsigned antialias) {
    return {.antialias = antialias, .winds_once = antialias > 1 && winds_once({&layer, 1})};
}

/// Costs on one thread, one step after the other.
struct Steps {
    Cost slicing;
    Cost raster;
    Cost images; ///< the raster, the image files in memory, and the updates of the thumbnails
};

Steps steps_of(const Part& part, const std::string& path, unsigned antialias) {
    const Execution alone{.threads = 1};
    Steps steps{};
    OpenedPart opened;
    LayerStack layers;
    steps.slicing = cost_of([&] {
        opened = open_part(part, alone);
        layers = slice(opened.mesh, opened.plan, {.execution = alone});
    });
    const PixelGrid grid = grid_of(opened.box);
    steps.raster = cost_of([&] {
        for (const Layer& layer : layers)
            rasterise({&layer, 1}, grid, raster_options(layer, antialias), [](auto, auto) {});
    });
    const auto writer = open_job(opened, path, antialias);
    steps.images = cost_of([&] {
        for (const Layer& layer : layers)
            static_cast<void>(writer->prepare(layer)); // makes the image; the function returned would write
                                                       // it
    });
    return steps;
}

/// Touches the pixels of all layers once, in one image that is reused.
void touch(std::size_t layers) {
    const auto pixels = std::make_unique<unsigned char[]>(std::size_t{width} * height);
    for (std::size_t i = 0; i < layers; ++i) {
        std::memset(pixels.get(), static_cast<int>(i), std::size_t{width} * height);
        const volatile unsigned char seen = pixels[i % width]; // prevents elimination of the memset
        static_cast<void>(seen);
    }
}

/// Returns whether each layer's image covers the area of the section. It must be exact, except in layers with
/// overlaps for parts of rows where many edges are close together; each point of a contour may be such a
/// part.
bool right(const Part& part, unsigned antialias) {
    const OpenedPart opened = open_part(part, {});
    const double mm = pixel_mm(opened.box);
    const PixelGrid grid = grid_of(opened.box);
    const std::vector<double> areas = section_areas(opened.mesh, opened.plan);
    const LayerStack layers = slice(opened.mesh, opened.plan);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const RasterOptions options = raster_options(layers[i], antialias);
        const double covered = rasterise({&layers[i], 1}, grid, options, [](auto, auto) {}).covered * mm * mm;
        const LayerMeasure measured = measure(layers[i]);
        double bound = 1e-9 * areas[i];
        if (antialias == 1)
            bound += mm * measured.perimeter_mm;
        else if (!options.winds_once)
            bound += mm * mm / antialias * static_cast<double>(measured.points);
        if (std::abs(covered - areas[i]) > bound + 1e-9)
            return false;
    }
    return true;
}

struct Costs {
    std::vector<Cost> slicing, raster, images, job, touching;

    void add(const Steps& steps) {
        slicing.push_back(steps.slicing);
        raster.push_back(steps.raster);
        images.push_back(steps.images);
    }
};

std::string seconds(double s) {
    return fmt::format("{:.3f}", s);
}

int report(int argc, char** argv) {
    const Options options(argc, argv,
                          "raster [--parts sheet-1225,sheet-1225-shuffled,sheet-100-on-edge,rook,lattice] "
                          "[--antialias 1,4,16] [--rounds 3] [--seconds 60]");
    const int rounds = options.rounds();
    const double limit = options.number("--seconds");
    std::cout << machine() << "; least of " << rounds << " rounds\n\n";

    bool all_right = true;
    for (const Part& part : chosen_parts(options)) {
        if (part.name.ends_with("shuffled"))
            continue; // the same images
        Table table({part.name, "layers", "file MB", "slicing CPU s", "raster CPU s", "PNG CPU s",
                     "job CPU s", "job s", "touching all s", "checked"});
        const auto layers =
            measure_in_child<std::size_t>([&] { return open_part(part, {}).plan.layers.size(); }).result;
        for (const std::string& level : options.list("--antialias")) {
            const auto antialias = static_cast<unsigned>(std::stoul(level));
            const std::string path = part.path + ".sl1s";
            Costs costs;
            repeat(rounds, limit, [&] {
                costs.add(measure_in_child<Steps>([&] { return steps_of(part, path, antialias); }).result);
                std::filesystem::remove(path); // freeing the blocks of the old file is not part of writing
                costs.job.push_back(measure_in_child<Cost>([&] {
                                        return cost_of([&] { into_job(part, path, antialias); });
                                    }).result);
                costs.touching.push_back(
                    measure_in_child<Cost>([&] { return cost_of([&] { touch(layers); }); }).result);
            });
            const bool is_right = measure_in_child<bool>([&] { return right(part, antialias); }).result;
            all_right = all_right && is_right;
            const double raster = least(costs.raster).cpu_s;
            table.add({"antialias " + level, fmt::to_string(layers),
                       fmt::format("{:.1f}", static_cast<double>(std::filesystem::file_size(path)) / 1e6),
                       seconds(least(costs.slicing).cpu_s), seconds(raster),
                       seconds(least(costs.images).cpu_s - raster), seconds(least(costs.job).cpu_s),
                       seconds(least(costs.job).wall_s), seconds(least(costs.touching).cpu_s),
                       is_right ? "yes" : "WRONG"});
            std::filesystem::remove(path);
        }
        std::cout << table.text() << std::endl;
    }
    return all_right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
