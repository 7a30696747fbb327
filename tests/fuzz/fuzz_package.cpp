// Any texts as the parts of a 3MF package, behind the checksums and the compression of the archive: an error,
// or instances of sound meshes that lie at finite places, and sound layers of its slices. Parts are separated
// by a NUL: the root model, another one ("3D/a.model"), and the relationships of the root
// ("3D/_rels/3dmodel.model.rels").

#include "archive.hpp"
#include "promises.hpp"

#include <algorithm>
#include <span>

namespace {

using namespace lamella;
using fuzz::require;

void read_meshes(const std::string& bytes) {
    try {
        const MeshFile file = read_mesh(std::as_bytes(std::span(bytes)), "fuzz",
                                        {.max_triangles = 50'000, .max_memory = 100'000'000}, {.threads = 1});
        require(!file.objects.empty() && !file.instances.empty());
        if (file.format == "stl-binary")
            return; // the archive happens to have the count of one
        for (const MeshObject& object : file.objects) {
            require(!object.mesh.empty());
            check(*object.mesh.indexed());
        }
        for (const MeshInstance& instance : file.instances) {
            require(finite(instance.placement));
            const Box3 box = bounding_box(file.objects[instance.object].mesh);
            for (const Point3& corner : {instance.placement(box.min), instance.placement(box.max)})
                require(std::isfinite(corner.x) && std::isfinite(corner.y) && std::isfinite(corner.z));
        }
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
}

void read_slices(const std::string& bytes) {
    try {
        fuzz::require_sound(read_layers(std::as_bytes(std::span(bytes)), "fuzz", {.max_memory = 100'000'000},
                                        {.threads = 1}));
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    fuzz::Archive archive;
    for (const char* name : {"3D/3dmodel.model", "3D/a.model", "3D/_rels/3dmodel.model.rels"}) {
        const std::size_t end = std::min(text.find('\0'), text.size());
        archive.add(name, text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    const std::string bytes = archive.take();
    read_meshes(bytes);
    read_slices(bytes);
    return 0;
}
