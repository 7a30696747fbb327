// Writes the scan vectors of a part in all formats that keep exposures, and the exact ones as JSON of layers,
// into the folder given: for other readers to compare.

#include "parts/shapes.hpp"

#include <lamella/formats.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace lamella;

void write_samples(const std::string& folder) {
    const Mesh mesh(make_rook());
    const Box3 box = bounding_box(mesh);
    const LayerStack layers = slice(mesh, plan_uniform(box.min.z, box.max.z, {.layer_height = 4}));
    ScanStrategy strategy;
    strategy.contours.count = 3;
    strategy.hatch.distance = 0.6;
    strategy.upskin.layers = 1;
    strategy.downskin.layers = 1;
    std::vector<Plane> planes;
    LayerFileInfo info{.box = box, .layers = layers.size(), .bottom = layers.front().bottom};
    info.parts.clear();
    for (const Exposure& exposure : exposures(strategy, "rook"))
        info.parts.push_back({.label = "rook " + exposure.name(), .box = info.box, .exposure = exposure});
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::vector<ScanLayer> below(layers.rend() - static_cast<std::ptrdiff_t>(i), layers.rend());
        const std::vector<ScanLayer> above(layers.begin() + static_cast<std::ptrdiff_t>(i) + 1, layers.end());
        planes.push_back(scan(layers[i], below, above, strategy).vectors);
    }
    for (const char* format : {"json", "ilt", "ovf", "3mf-toolpath"})
        write_layers(folder + "/rook." + format, layer_format(format, ""), planes, info);
}

} // namespace

int main(int count, char** arguments) {
    try {
        if (count != 2)
            throw lamella::Error(lamella::ErrorKind::usage, "give a folder");
        write_samples(arguments[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
