#include <lamella/lamella.hpp>

#include <cstdio>

int main() {
    const lamella::IndexedMesh mesh{
        .vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
    };
    const lamella::Plan plan = lamella::plan_uniform(0, 10, {.layer_height = 0.5});

    // `prepare` does the work: several threads call it, in any order. The commits that it returns are called
    // one at a time, in the order of the layers: they output the results. Longer work can follow a commit
    // (lamella::Completions).
    const lamella::LayerSink sink{.prepare = [](lamella::Layer&& layer) -> lamella::Commit {
        const double area = lamella::measure(layer).area_mm2;
        return [z = layer.z, area] {
            std::printf("%5.2f mm  %7.3f mm2\n", z, area);
        };
    }};
    lamella::slice_to(sink, mesh, plan);
}
