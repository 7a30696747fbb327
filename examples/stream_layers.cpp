#include <lamella/lamella.hpp>

#include <cstdio>

int main() {
    const lamella::IndexedMesh mesh{
        .vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
    };
    const lamella::Plan plan = lamella::plan_uniform(0, 10, {.layer_height = 0.5});

    // The sink does the work: several threads call it, in any order. The functions that it returns are called
    // in the order of the layers, one at a time: they output the results.
    const auto sink = [](lamella::Layer&& layer) -> std::function<void()> {
        const double area = lamella::measure(layer).area_mm2;
        return [z = layer.z, area] {
            std::printf("%5.2f mm  %7.3f mm2\n", z, area);
        };
    };
    lamella::slice_to(sink, mesh, plan);
}
