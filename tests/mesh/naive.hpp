#pragma once

// Slow and obvious implementations of functions of the library.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace lamella {

inline IndexedMesh naive_weld(const TriangleSoup& soup) {
    IndexedMesh out;
    std::map<std::array<double, 3>, std::uint32_t> seen;
    for (std::size_t i = 0; i < soup.size(); ++i) {
        std::array<std::uint32_t, 3> ids{};
        const Triangle3 t = soup.placed(i);
        for (int k = 0; k < 3; ++k) {
            const auto [at, fresh] =
                seen.try_emplace({t[k].x, t[k].y, t[k].z}, static_cast<std::uint32_t>(out.vertices.size()));
            if (fresh)
                out.vertices.push_back(t[k]);
            ids[k] = at->second;
        }
        out.triangles.push_back(ids);
    }
    return out;
}

struct EdgeCounts {
    std::uint64_t boundary = 0;    ///< one triangle
    std::uint64_t nonmanifold = 0; ///< more than two
    std::uint64_t unbalanced = 0;  ///< two or more, with different numbers in the two directions
    std::uint64_t degenerate_triangles = 0;

    friend bool operator==(const EdgeCounts&, const EdgeCounts&) = default;
};

inline bool naive_degenerate(const std::array<std::uint32_t, 3>& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

inline EdgeCounts naive_edges(const IndexedMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;
    EdgeCounts out;
    for (const auto& t : mesh.triangles) {
        if (naive_degenerate(t)) {
            ++out.degenerate_triangles;
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k];
            const std::uint32_t b = t[(k + 1) % 3];
            auto& uses = edges[std::minmax(a, b)];
            ++(a < b ? uses.first : uses.second);
        }
    }
    for (const auto& [edge, uses] : edges) {
        const int all = uses.first + uses.second;
        out.boundary += all == 1;
        out.nonmanifold += all > 2;
        out.unbalanced += all > 1 && uses.first != uses.second;
    }
    return out;
}

inline std::uint64_t naive_duplicates(const IndexedMesh& mesh) {
    std::set<std::array<std::uint32_t, 3>> seen;
    std::uint64_t out = 0;
    for (std::array<std::uint32_t, 3> t : mesh.triangles) {
        std::sort(t.begin(), t.end());
        out += !naive_degenerate(t) && !seen.insert(t).second;
    }
    return out;
}

/// Counts parts connected by edges, by flooding.
inline std::uint64_t naive_shells(const IndexedMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> at_edge;
    const auto edge = [&](std::size_t i, int k) {
        return std::pair(std::minmax(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]));
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3 && !naive_degenerate(mesh.triangles[i]); ++k)
            at_edge[edge(i, k)].push_back(i);
    std::vector<bool> visited(mesh.triangles.size(), false);
    std::uint64_t out = 0;
    for (std::size_t start = 0; start < mesh.triangles.size(); ++start) {
        if (visited[start] || naive_degenerate(mesh.triangles[start]))
            continue;
        ++out;
        std::vector<std::size_t> todo{start};
        visited[start] = true;
        while (!todo.empty()) {
            const std::size_t i = todo.back();
            todo.pop_back();
            for (int k = 0; k < 3; ++k)
                for (const std::size_t next : std::exchange(at_edge[edge(i, k)], {}))
                    if (!visited[next]) {
                        visited[next] = true;
                        todo.push_back(next);
                    }
        }
    }
    return out;
}

/// Returns whether the mesh is closed and every edge has exactly two triangles, in opposite directions.
inline bool two_manifold(const TriangleSoup& soup) {
    return naive_edges(naive_weld(soup)) == EdgeCounts{};
}

inline double naive_area(const Triangle3& t) {
    const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
    const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
    return std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x) / 2;
}

} // namespace lamella
