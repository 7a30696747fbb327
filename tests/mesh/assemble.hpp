#pragma once

// Builds meshes from other meshes, and random ones.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "fixtures/random.hpp"

#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <vector>

namespace lamella {

inline std::vector<Triangle3f> triangles_of(const TriangleSoup& soup) {
    std::vector<Triangle3f> out;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const Triangle3 t = soup.placed(i);
        const auto single = [](const Point3& p) {
            return Point3f{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        };
        out.push_back({single(t[0]), single(t[1]), single(t[2])});
    }
    return out;
}

inline TriangleSoup moved(const TriangleSoup& soup, double x, double y, double z) {
    return soup.transformed(translation(x, y, z));
}

/// Returns all triangles of all parts, placed, in one soup.
inline TriangleSoup assemble(std::initializer_list<TriangleSoup> parts) {
    std::vector<Triangle3f> out;
    for (const TriangleSoup& part : parts) {
        const std::vector<Triangle3f> triangles = triangles_of(part);
        out.insert(out.end(), triangles.begin(), triangles.end());
    }
    return TriangleSoup(std::move(out));
}

inline TriangleSoup inside_out(const TriangleSoup& soup) {
    std::vector<Triangle3f> out = triangles_of(soup);
    for (Triangle3f& t : out)
        std::swap(t[1], t[2]);
    return TriangleSoup(std::move(out));
}

/// Adds triangles between random vertices, some of them degenerate.
inline void add_random_triangles(IndexedMesh& mesh, std::int64_t count, test::Random& random) {
    const auto any = [&] {
        return static_cast<std::uint32_t>(random.integer(0, std::ssize(mesh.vertices) - 1));
    };
    for (; count > 0; --count)
        mesh.triangles.push_back({any(), any(), any()});
}

} // namespace lamella
