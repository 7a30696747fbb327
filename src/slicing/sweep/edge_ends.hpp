#pragma once

// Where the ends of edges are. If the triangles are in memory, they are read from there: an edge is a side of
// a triangle. Otherwise they are stored once per edge.

#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

namespace lamella {

/// The two ends of an edge.
template <class Vertex>
struct EdgeEnds {
    Vertex low, high;

    friend bool operator==(const EdgeEnds&, const EdgeEnds&) = default;
};

// Each class returns the vertices at both ends of a side, in the order of the triangle. Sides have numbers: 3
// t + i for the side of triangle t that begins at its corner i. Vertices are the same if and only if they are
// equal.

/// Ends in a soup without a placement: the coordinates themselves.
class SoupEnds {
  public:
    using Vertex = Point3f;

    explicit SoupEnds(TriangleSoup soup)
        : soup_(std::move(soup)), data_(soup_.data()), stride_(soup_.stride()) {}

    [[nodiscard]] std::array<Vertex, 2> operator()(std::uint32_t side) const noexcept {
        const std::byte* const triangle = data_ + (side / 3) * stride_;
        const std::uint32_t corner = side % 3;
        return {vertex(triangle, corner), vertex(triangle, corner == 2 ? 0 : corner + 1)};
    }
    [[nodiscard]] static Point3 point(const Vertex& v) noexcept { return {v.x, v.y, v.z}; }
    void prefetch(std::uint32_t side) const noexcept {
        const std::byte* const triangle = data_ + (side / 3) * stride_;
        __builtin_prefetch(triangle);
        __builtin_prefetch(triangle + sizeof(Triangle3f) - 1);
    }

  private:
    static Vertex vertex(const std::byte* triangle, std::uint32_t corner) noexcept {
        Vertex v;
        std::memcpy(&v, triangle + sizeof v * corner, sizeof v);
        return {v.x + 0.0F, v.y + 0.0F, v.z + 0.0F}; // -0 becomes +0
    }

    TriangleSoup soup_;
    const std::byte* data_;
    std::size_t stride_;
};

/// Ends in a soup with a placement: the coordinates after it.
class PlacedEnds {
  public:
    using Vertex = Point3;

    explicit PlacedEnds(TriangleSoup soup) : soup_(std::move(soup)) {}

    [[nodiscard]] std::array<Vertex, 2> operator()(std::uint32_t side) const noexcept {
        const Triangle3 triangle = soup_.placed(side / 3);
        const std::uint32_t corner = side % 3;
        return {triangle[corner], triangle[corner == 2 ? 0 : corner + 1]};
    }
    [[nodiscard]] static Point3 point(const Vertex& v) noexcept { return v; }
    void prefetch(std::uint32_t side) const noexcept {
        __builtin_prefetch(soup_.data() + (side / 3) * soup_.stride());
    }

  private:
    TriangleSoup soup_;
};

/// Ends in an indexed mesh, which must outlive this: the indices.
class IndexedEnds {
  public:
    using Vertex = std::uint32_t;

    explicit IndexedEnds(const IndexedMesh& mesh)
        : triangles_(mesh.triangles.data()), vertices_(mesh.vertices.data()) {}

    [[nodiscard]] std::array<Vertex, 2> operator()(std::uint32_t side) const noexcept {
        const std::array<std::uint32_t, 3>& triangle = triangles_[side / 3];
        const std::uint32_t corner = side % 3;
        return {triangle[corner], triangle[corner == 2 ? 0 : corner + 1]};
    }
    [[nodiscard]] Point3 point(Vertex v) const noexcept { return vertices_[v]; }
    void prefetch(std::uint32_t side) const noexcept { __builtin_prefetch(triangles_ + side / 3); }

  private:
    const std::array<std::uint32_t, 3>* triangles_;
    const Point3* vertices_;
};

} // namespace lamella
