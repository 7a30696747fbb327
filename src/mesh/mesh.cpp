#include "lamella/mesh/mesh.hpp"

#include "lamella/core/error.hpp"

#include "core/farthest.hpp"
#include "mesh/joined_vertices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace lamella {

Mesh::Mesh(TriangleSoup soup) : soup_(std::move(soup)) {}

/// Caches the result of joining the repeated vertices of an indexed mesh.
struct Mesh::Joined {
    std::mutex mutex;
    bool known = false;
    std::shared_ptr<const IndexedMesh> mesh; ///< null if no vertices are repeated
};

Mesh::Mesh(IndexedMesh mesh)
    : indexed_(std::make_shared<const IndexedMesh>(std::move(mesh))), joined_(std::make_shared<Joined>()) {
    check(*indexed_); // all other code relies on valid indices and coordinates
}

Mesh Mesh::with_joined_vertices(const Execution& execution) const {
    if (!indexed_)
        return *this;
    const std::lock_guard lock(joined_->mutex);
    if (!joined_->known) {
        if (std::optional<IndexedMesh> joined = joined_vertices(*indexed_, execution))
            joined_->mesh = std::make_shared<const IndexedMesh>(*std::move(joined));
        joined_->known = true;
    }
    if (!joined_->mesh)
        return *this;
    Mesh mesh;
    mesh.indexed_ = joined_->mesh;
    mesh.joined_ = std::make_shared<Joined>();
    mesh.joined_->known = true;
    return mesh;
}

Mesh Mesh::transformed(const Transform& map) const {
    if (map == Transform{})
        return *this;
    if (!indexed_)
        return Mesh(soup_.transformed(map));
    IndexedMesh moved = lamella::transformed(*indexed_, map);
    if (std::any_of(moved.vertices.begin(), moved.vertices.end(),
                    [](const Point3& p) { return is_too_far(p); }))
        throw Error(ErrorKind::usage,
                    fmt::format("the mesh: reaches beyond {} mm once it is transformed", farthest_mm));
    return Mesh(std::move(moved));
}

Box3 bounding_box(const Mesh& mesh, const Execution& execution) {
    return mesh.visit([&](const auto& kind) { return bounding_box(kind, execution); });
}

double volume(const Mesh& mesh, const Execution& execution) {
    return mesh.visit([&](const auto& kind) { return volume(kind, execution); });
}

IndexedMesh weld(const Mesh& mesh, const Execution& execution) {
    return mesh.visit([&](const auto& kind) { return weld(kind, execution); });
}

Mesh joined(std::span<const Mesh> meshes, const Execution& execution) {
    if (meshes.size() == 1)
        return meshes.front();
    const auto require_indices = [&](std::uint64_t vertices_or_triangles) {
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        if (vertices_or_triangles > most)
            throw Error(ErrorKind::limit, fmt::format("{} meshes together have more than {} vertices or "
                                                      "triangles: more than can be indexed",
                                                      meshes.size(), most));
    };
    std::uint64_t triangles = 0;
    for (const Mesh& mesh : meshes)
        triangles += mesh.size();
    require_indices(triangles);
    IndexedMesh all;
    all.triangles.reserve(triangles);
    for (const Mesh& mesh : meshes) {
        IndexedMesh welded;
        if (mesh.indexed() == nullptr)
            welded = weld(*mesh.soup(), execution);
        const IndexedMesh& part = mesh.indexed() != nullptr ? *mesh.indexed() : welded;
        require_indices(all.vertices.size() + part.vertices.size());
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const auto& t : part.triangles)
            all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return Mesh(std::move(all));
}

} // namespace lamella
