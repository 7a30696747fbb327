// What do pictures cost? From STL file to a job of pictures with 2560 x 1620 pixels, against slicing into
// memory and against touching every one of these pixels once (memset). The covered areas are compared with
// those of the sections.
//
//     raster [--rounds 5] [--threads 2]

#include "experiment.hpp"
#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

namespace lamella::bench {

namespace {

constexpr std::uint32_t width = 2560;
constexpr std::uint32_t height = 1620;

/// Square pixels, as small as lets the part fill the display.
double pixel_mm(const Box3& box) {
    return std::max((box.max.x - box.min.x) / width, (box.max.y - box.min.y) / height);
}

double into_job(const Part& part, const std::string& path, unsigned antialias, unsigned threads) {
    const auto start = Clock::now();
    const Execution execution{.threads = threads};
    const OpenedPart opened = open_part(part, execution);
    const double mm = pixel_mm(opened.box);
    const LayerFileInfo info{
        .box = opened.box, .layers = opened.plan.layers.size(), .bottom = opened.plan.layers.front().bottom};
    const auto writer = open_layer_writer(path, layer_format("sl1s", ""), info,
                                          {.picture = {.pixel_mm = {{mm, mm}},
                                                       .pixels = {{width, height}},
                                                       .portrait = false,
                                                       .raster = {.antialias = antialias}}});
    slice_to([&](Layer&& layer) { return writer->prepare(layer); }, opened.mesh, opened.plan, execution);
    writer->finish();
    return seconds_since(start);
}

/// Touching the pixels of all layers once, by one thread in a picture that is used again.
double touching(std::size_t layers) {
    const auto pixels = std::make_unique<unsigned char[]>(std::size_t{width} * height);
    std::memset(pixels.get(), 1, std::size_t{width} * height);
    const auto start = Clock::now();
    for (std::size_t i = 0; i < layers; ++i) {
        std::memset(pixels.get(), static_cast<int>(i), std::size_t{width} * height);
        const volatile unsigned char seen = pixels[i % width]; // so that it happens
        static_cast<void>(seen);
    }
    return seconds_since(start);
}

/// Whether each layer's picture covers the area of the section: the middles of strips speak for them, so
/// each point of a contour may be wrong by a strip of a pixel or two.
bool right(const Part& part, unsigned antialias) {
    const OpenedPart opened = open_part(part, {});
    const double mm = pixel_mm(opened.box);
    const PixelGrid grid{.width = width,
                         .height = height,
                         .ux = 1 / mm,
                         .u0 = -opened.box.min.x / mm,
                         .vy = 1 / mm,
                         .v0 = -opened.box.min.y / mm};
    const std::vector<double> areas = section_areas(opened.mesh, opened.plan);
    const LayerStack layers = slice(opened.mesh, opened.plan);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const double covered =
            rasterise({&layers[i], 1}, grid, {.antialias = antialias}, [](auto, auto) {}) * mm * mm;
        const LayerMeasure measured = measure(layers[i]);
        const double bound = antialias == 1 ? mm * measured.perimeter_mm
                                            : mm * mm / antialias * static_cast<double>(measured.points);
        if (std::abs(covered - areas[i]) > bound + 1e-9)
            return false;
    }
    return true;
}

int report(int argc, char** argv) {
    const int rounds = std::stoi(option(argc, argv, "--rounds", "5"));
    const auto threads = static_cast<unsigned>(
        std::stoul(option(argc, argv, "--threads", std::to_string(std::thread::hardware_concurrency()))));
    std::cout << machine() << "; medians of " << rounds << " rounds, " << threads << " threads\n\n";

    Table table({"part", "layers", "antialias", "file MB", "into memory s", "into job s", "added Gpixel/s",
                 "touching all s", "added / touching", "peak MB", "checked"});
    bool all_right = true;
    for (const Part& part : standard_parts()) {
        if (part.name.ends_with("shuffled"))
            continue; // the same pictures
        const auto layers =
            measure_in_child<std::size_t>([&] { return open_part(part, {}).plan.layers.size(); });
        const double pixels = static_cast<double>(layers.result) * width * height;
        for (const unsigned antialias : {1U, 4U, 16U}) {
            const std::string path = part.path + ".sl1s";
            std::vector<double> memory;
            std::vector<double> job;
            std::vector<double> touch;
            std::vector<double> added;
            std::uint64_t peak = 0;
            for (int round = 0; round < rounds; ++round) {
                memory.push_back(
                    measure_in_child<double>([&] { return seconds_into_memory(part, threads); }).result);
                std::filesystem::remove(path);
                const auto run =
                    measure_in_child<double>([&] { return into_job(part, path, antialias, threads); });
                job.push_back(run.result);
                peak = std::max(peak, run.peak_bytes);
                touch.push_back(measure_in_child<double>([&] { return touching(layers.result); }).result);
                added.push_back(job.back() - memory.back());
            }
            const bool is_right = measure_in_child<bool>([&] { return right(part, antialias); }).result;
            all_right = all_right && is_right;
            table.add({part.name, fmt::to_string(layers.result), fmt::to_string(antialias),
                       fmt::format("{:.1f}", static_cast<double>(std::filesystem::file_size(path)) / 1e6),
                       fmt::format("{:.4f}", median(memory)), fmt::format("{:.4f}", median(job)),
                       fmt::format("{:.1f}", pixels / median(added) / 1e9),
                       fmt::format("{:.4f}", median(touch)),
                       fmt::format("{:.2f}", median(added) / median(touch)),
                       fmt::format("{:.0f}", static_cast<double>(peak) / 1e6), is_right ? "yes" : "WRONG"});
            std::filesystem::remove(path);
        }
    }
    std::cout << table.text();
    return all_right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
