#include <lamella/jobs.hpp>

int main() {
    const lamella::Plate plate = lamella::load_plate(std::array{lamella::PlateInput{.path = "part.stl"}});
    const lamella::Box3& box = plate.box;
    const lamella::Plan plan = lamella::plan_uniform(box.min.z, box.max.z, {.layer_height = 0.1});
    const lamella::LayerStack layers = lamella::slice(plate, plan);
    lamella::write_layers("part.cli", layers);
}
