#include <lamella/io.hpp>

int main() {
    const lamella::MeshFile part = lamella::read_mesh("part.stl");
    const lamella::Box3 box = lamella::bounding_box(part.mesh());
    const lamella::Plan plan = lamella::plan_uniform(box.min.z, box.max.z, {.layer_height = 0.1});
    const lamella::LayerStack layers = lamella::slice(part.mesh(), plan);
    lamella::write_layers("part.cli", layers);
}
