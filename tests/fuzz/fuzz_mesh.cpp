// Any bytes as a mesh file of any format: an error of the input kind, or a mesh that welds, inspects and
// slices to layers that keep their promises.

#include "promises.hpp"

#include <span>

namespace {

using lamella::fuzz::require;

void slice_and_check(const lamella::Mesh& mesh) {
    using namespace lamella;
    const Box3 box = bounding_box(mesh);
    if (!(box.min.z < box.max.z))
        return;
    const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = (box.max.z - box.min.z) / 7});
    const LayerStack as_it_is = slice(mesh, plan, {.execution = {.threads = 1}});
    const IndexedMesh welded = weld(mesh, {.threads = 2});
    const LayerStack by_mesh = slice(welded, plan, {.execution = {.threads = 2}});
    const Inspection inspection = inspect(welded, {.threads = 1});
    require(as_it_is.size() == plan.layers.size() && by_mesh.size() == as_it_is.size());
    for (std::size_t i = 0; i < as_it_is.size(); ++i) {
        require(in_normal_form(as_it_is[i]));
        require(in_normal_form(by_mesh[i]));
        // A file with indices may keep equal corners apart, and is open there.
        require(mesh.soup() == nullptr || same_contours(as_it_is[i], by_mesh[i]));
        require(!inspection.closed() || by_mesh[i].open_chains() == 0);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        // A few lines of a 3MF file can ask for a million parts.
        const lamella::MeshReadOptions options{.max_triangles = 50'000, .max_memory = 100'000'000};
        const auto file =
            lamella::read_mesh(std::as_bytes(std::span(data, size)), "fuzz", options, {.threads = 1});
        slice_and_check(file.mesh());
    } catch (const lamella::Error& error) {
        require(error.kind() == lamella::ErrorKind::input || error.kind() == lamella::ErrorKind::usage ||
                error.kind() == lamella::ErrorKind::limit);
    }
    return 0;
}
