// The engine on its own: a mesh of arrays in, contours on the screen. It reads and writes no file.
#include <lamella/lamella.hpp>

#include <iostream>

int main() {
    const lamella::IndexedMesh pyramid{
        .vertices = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}, {4, 4, 4}},
        .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
    };
    const lamella::Plan plan = lamella::plan_uniform(0, 4, {.layer_height = 2});
    for (const lamella::Layer& layer : lamella::slice(pyramid, plan)) {
        std::cout << "z = " << layer.z << " mm\n";
        for (std::size_t i = 0; i < layer.contours(); ++i)
            for (const lamella::Point2& p : layer.contour(i))
                std::cout << "  (" << p.x << ", " << p.y << ")\n";
    }
}
