#include <lamella/lamella.hpp>

// Slices arrays with the engine alone.
int main() {
    const lamella::IndexedMesh pyramid{{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}, {4, 4, 4}},
                                       {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
    const lamella::LayerStack layers =
        lamella::slice(pyramid, lamella::plan_uniform(0, 4, {.layer_height = 2}));
    return layers.size() == 2 && lamella::measure(layers[0]).area_mm2 == 36 ? 0 : 1;
}
