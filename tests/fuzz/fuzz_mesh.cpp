// Any bytes as an STL file: an error of the input kind, or a mesh that welds, inspects and slices to layers
// that keep their promises.

#include <lamella/lamella.hpp>

#include <cstdlib>
#include <span>

namespace {

void require(bool promise) {
    if (!promise)
        std::abort();
}

void slice_and_check(const lamella::Mesh& mesh) {
    using namespace lamella;
    const Box3 box = bounding_box(mesh);
    if (!(box.min.z < box.max.z))
        return;
    const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = (box.max.z - box.min.z) / 7});
    const LayerStack by_soup = slice(mesh, plan, {.threads = 1});
    const IndexedMesh welded = weld(mesh, {.threads = 2});
    const LayerStack by_mesh = slice(welded, plan, {.threads = 2});
    const Inspection inspection = inspect(welded, {.threads = 1});
    require(by_soup.size() == plan.layers.size() && by_mesh.size() == by_soup.size());
    for (std::size_t i = 0; i < by_soup.size(); ++i) {
        require(in_normal_form(by_soup[i]));
        require(same_contours(by_soup[i], by_mesh[i]));
        require(!inspection.closed() || by_soup[i].open_chains() == 0);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const auto file =
            lamella::read_mesh(std::as_bytes(std::span(data, size)), "fuzz", {}, {.threads = 1});
        slice_and_check(file.mesh());
    } catch (const lamella::Error& error) {
        require(error.kind() == lamella::ErrorKind::input || error.kind() == lamella::ErrorKind::usage);
    }
    return 0;
}
