// Cuts a mesh with single planes, level and tilted ones, as an interactive program does.
#include <lamella/lamella.hpp>

#include <cstdio>

int main() {
    const lamella::IndexedMesh mesh{
        .vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
    };
    const lamella::Slicer slicer(mesh); // prepares the mesh once
    for (const double z : {2.5, 5.0})
        std::printf("z = %.1f mm: %.3f mm2\n", z, lamella::measure(slicer.section(z)).area_mm2);

    const lamella::PlaneSection tilted = slicer.section({2, 2, 2}, {1, 1, 1});
    for (const lamella::Point2& p : tilted.layer.contour(0)) {
        const lamella::Point3 corner = tilted.point(p); // in the coordinates of the mesh
        std::printf("(%.3f, %.3f, %.3f)\n", corner.x, corner.y, corner.z);
    }
}
