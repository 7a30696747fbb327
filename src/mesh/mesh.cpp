#include "lamella/mesh/mesh.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <utility>

namespace lamella {

Mesh::Mesh(TriangleSoup soup) : soup_(std::move(soup)) {}

Mesh::Mesh(IndexedMesh mesh) : indexed_(std::make_shared<const IndexedMesh>(std::move(mesh))) {}

Mesh Mesh::transformed(const Transform& map) const {
    if (map == Transform{})
        return *this;
    return indexed_ ? Mesh(lamella::transformed(*indexed_, map)) : Mesh(soup_.transformed(map));
}

Box3 bounding_box(const Mesh& mesh, const Execution& execution) {
    return mesh.indexed() != nullptr ? bounding_box(*mesh.indexed(), execution)
                                     : bounding_box(*mesh.soup(), execution);
}

double volume(const Mesh& mesh, const Execution& execution) {
    return mesh.indexed() != nullptr ? volume(*mesh.indexed(), execution) : volume(*mesh.soup(), execution);
}

IndexedMesh weld(const Mesh& mesh, const Execution& execution) {
    return mesh.indexed() != nullptr ? weld(*mesh.indexed(), execution) : weld(*mesh.soup(), execution);
}

Mesh joined(std::span<const Mesh> meshes, const Execution& execution) {
    if (meshes.size() == 1)
        return meshes.front();
    IndexedMesh all;
    for (const Mesh& mesh : meshes) {
        IndexedMesh welded;
        if (mesh.indexed() == nullptr)
            welded = weld(*mesh.soup(), execution);
        const IndexedMesh& part = mesh.indexed() != nullptr ? *mesh.indexed() : welded;
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        if (part.vertices.size() > most - all.vertices.size() ||
            part.triangles.size() > most - all.triangles.size())
            throw Error(ErrorKind::limit, fmt::format("{} meshes together have more than {} vertices or "
                                                      "triangles: more than can be indexed",
                                                      meshes.size(), most));
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
        all.triangles.reserve(all.triangles.size() + part.triangles.size());
        for (const auto& t : part.triangles)
            all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return Mesh(std::move(all));
}

} // namespace lamella
