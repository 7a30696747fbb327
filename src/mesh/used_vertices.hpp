#pragma once

#include "lamella/mesh/indexed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// Drops vertices that no triangle names; the others keep their order. (The box of a mesh is that of all its
/// vertices.)
inline void keep_used_vertices(IndexedMesh& mesh) {
    constexpr std::uint32_t unused = 0xffffffff;
    std::vector<std::uint32_t> number(mesh.vertices.size(), unused);
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t)
            number[v] = 0;
    std::uint32_t next = 0;
    for (std::size_t v = 0; v < number.size(); ++v)
        if (number[v] != unused) {
            mesh.vertices[next] = mesh.vertices[v];
            number[v] = next++;
        }
    mesh.vertices.resize(next);
    for (auto& t : mesh.triangles)
        for (std::uint32_t& v : t)
            v = number[v];
}

} // namespace lamella
