#pragma once

// Meshes for the tests of repairs.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "fixtures/random.hpp"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace lamella::repair_cases {

using test::Random;

/// Triangles as coordinates, in order.
inline std::vector<Triangle3> coordinates(const IndexedMesh& mesh) {
    std::vector<Triangle3> out;
    for (const auto& t : mesh.triangles)
        out.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    return out;
}

/// The same mesh with its vertices in another order.
inline IndexedMesh renumbered(const IndexedMesh& mesh, Random& random) {
    std::vector<std::uint32_t> number(mesh.vertices.size());
    std::iota(number.begin(), number.end(), 0U);
    for (std::size_t i = number.size(); i > 1; --i)
        std::swap(number[i - 1],
                  number[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
    IndexedMesh out;
    out.vertices.resize(mesh.vertices.size());
    for (std::size_t v = 0; v < number.size(); ++v)
        out.vertices[number[v]] = mesh.vertices[v];
    for (const auto& t : mesh.triangles)
        out.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    return out;
}

/// Every triangle with corners of its own, each moved by up to `by` in each direction.
inline IndexedMesh jittered(const TriangleSoup& soup, double by, Random& random) {
    IndexedMesh out;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const Triangle3 t = soup.placed(i);
        const auto first = static_cast<std::uint32_t>(out.vertices.size());
        for (const Point3& p : t)
            out.vertices.push_back(
                {p.x + random.real(-by, by), p.y + random.real(-by, by), p.z + random.real(-by, by)});
        out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
}

} // namespace lamella::repair_cases
