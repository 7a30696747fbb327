#include <lamella/jobs.hpp>

#include <iostream>
#include <string>

// Slices a box, writes it, reads it back: the whole way through the installed library.
int main() {
    if (lamella::version() != std::string(LAMELLA_VERSION))
        return 1;
    const lamella::Mesh box(lamella::IndexedMesh{
        {{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {0, 10, 0}, {0, 0, 3}, {20, 0, 3}, {20, 10, 3}, {0, 10, 3}},
        {{0, 2, 1},
         {0, 3, 2},
         {4, 5, 6},
         {4, 6, 7},
         {0, 1, 5},
         {0, 5, 4},
         {1, 2, 6},
         {1, 6, 5},
         {2, 3, 7},
         {2, 7, 6},
         {3, 0, 4},
         {3, 4, 7}}});
    const lamella::LayerStack layers =
        lamella::slice(box, lamella::plan_uniform(0, 3, {.layer_height = 0.1}));
    for (const char* path : {"consumer.cli", "consumer.svg"}) {
        lamella::write_layers(path, layers);
        const lamella::LayerFile file = lamella::read_layers(path);
        const lamella::Verification check =
            lamella::verify(file.merged(), {.mesh = box, .rounding = file.rounding});
        std::cout << path << ": " << check.layers << " layers, " << check.volume_mm3 << " mm3\n";
        if (!check.ok() || check.layers != 30 || check.volume_mm3 < 599.9 || check.volume_mm3 > 600.1)
            return 1;
    }
}
