// Cuts a mesh with the library itself: what the Python package is measured against.
//
//     library_slicer MESH HEIGHTS RESULT
//
// HEIGHTS has one z a line; RESULT is JSON as the other slicers write it.

#include "lamella/formats.hpp"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void slice(const std::string& path, const std::string& heights, const std::string& result) {
    std::vector<double> z;
    std::ifstream lines(heights);
    for (double height; lines >> height;)
        z.push_back(height);

    auto start = Clock::now();
    const lamella::MeshFile file = lamella::read_mesh(path);
    const lamella::Mesh mesh = file.mesh();
    const double read_seconds = seconds_since(start);

    start = Clock::now();
    const std::clock_t before = std::clock();
    const lamella::LayerStack layers = lamella::slice(mesh, lamella::plan_listed(z));
    const double processor_seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    const double slice_seconds = seconds_since(start);

    std::string text = fmt::format(
        "{{\"seconds\": {{\"read\": {}, \"slice\": {}}}, \"processor_seconds\": {}, \"layers\": [",
        read_seconds, slice_seconds, processor_seconds);
    for (const lamella::Layer& layer : layers) {
        const lamella::LayerMeasure measured = lamella::measure(layer);
        text += fmt::format("{}\n{{\"z\": {}, \"contours\": {}, \"area_mm2\": {}, \"perimeter_mm\": {}}}",
                            &layer == &layers.front() ? "" : ",", layer.z, measured.contours,
                            measured.area_mm2, measured.perimeter_mm);
    }
    std::ofstream(result) << text << "]}\n";
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::cerr << "usage: library_slicer MESH HEIGHTS RESULT\n";
        return 2;
    }
    try {
        slice(argv[1], argv[2], argv[3]);
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
