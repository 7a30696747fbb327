#include "lamella/meshes/mesh_file.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

Mesh MeshFile::placed(std::size_t i) const {
    return objects[instances[i].object].mesh.transformed(instances[i].placement);
}

Mesh MeshFile::mesh(const Execution& execution) const {
    if (std::any_of(instances.begin(), instances.end(),
                    [](const MeshInstance& instance) { return instance.negative; }))
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: has negative volumes, and one mesh cannot be the parts without them; put "
                        "the file on a plate, whose layers are without them, or `include` negative to "
                        "read them as solids",
                        path));
    std::vector<Mesh> all;
    for (std::size_t i = 0; i < instances.size(); ++i)
        all.push_back(placed(i));
    return joined(all, execution);
}

} // namespace lamella
