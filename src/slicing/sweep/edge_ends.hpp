#pragma once

// The ends of edges. A node of the cut graph does not hold them: its edge is a side of a triangle, and its
// ends are read from the mesh when they are needed.

#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/transform.hpp"
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
// t + i for the side of triangle t that begins at its corner i. Two sides share a vertex if and only if these
// are equal.

/// Reads single corners of a soup, before its placement; -0 becomes +0.
class SoupCorners {
  public:
    explicit SoupCorners(TriangleSoup soup)
        : soup_(std::move(soup)), data_(soup_.data()), stride_(soup_.stride()) {}

    [[nodiscard]] Point3f operator()(std::uint32_t triangle, std::uint32_t corner) const noexcept {
        Point3f p;
        std::memcpy(&p, data_ + triangle * stride_ + sizeof p * corner, sizeof p);
        return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F}; // -0 becomes +0
    }
    void prefetch(std::uint32_t triangle) const noexcept {
        const std::byte* const first = data_ + triangle * stride_;
        __builtin_prefetch(first);
        __builtin_prefetch(first + sizeof(Triangle3f) - 1);
    }

  private:
    TriangleSoup soup_;
    const std::byte* data_;
    std::size_t stride_;
};

/// Ends in a soup without a placement: the coordinates themselves.
class SoupEnds {
  public:
    using Vertex = Point3f;

    explicit SoupEnds(const TriangleSoup& soup) : corners_(soup) {}

    [[nodiscard]] std::array<Vertex, 2> operator()(std::uint32_t side) const noexcept {
        const std::uint32_t corner = side % 3;
        return {corners_(side / 3, corner), corners_(side / 3, corner == 2 ? 0 : corner + 1)};
    }
    [[nodiscard]] static Point3 point(const Vertex& v) noexcept { return {v.x, v.y, v.z}; }
    void prefetch(std::uint32_t side) const noexcept { corners_.prefetch(side / 3); }

  private:
    SoupCorners corners_;
};

/// Ends in a soup with a placement: the coordinates after it.
class PlacedEnds {
  public:
    using Vertex = Point3;

    explicit PlacedEnds(const TriangleSoup& soup)
        : corners_(soup), placement_(soup.placement()), second_(soup.mirrored() ? 2 : 1) {}

    [[nodiscard]] std::array<Vertex, 2> operator()(std::uint32_t side) const noexcept {
        const std::uint32_t corner = side % 3;
        return {placed(side / 3, corner), placed(side / 3, corner == 2 ? 0 : corner + 1)};
    }
    [[nodiscard]] static Point3 point(const Vertex& v) noexcept { return v; }
    void prefetch(std::uint32_t side) const noexcept { corners_.prefetch(side / 3); }

  private:
    /// Returns the corner that TriangleSoup::placed returns with this index.
    [[nodiscard]] Point3 placed(std::uint32_t triangle, std::uint32_t corner) const noexcept {
        const Point3f p = corners_(triangle, corner == 0 ? 0 : corner == 1 ? second_ : 3 - second_);
        return placement_(Point3{p.x, p.y, p.z});
    }

    SoupCorners corners_;
    Transform placement_;
    std::uint32_t second_; ///< the stored corner that is the second one
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
