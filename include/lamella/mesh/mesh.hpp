#pragma once

// A mesh of either kind: a soup or an indexed mesh, as files contain them.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <cstddef>
#include <memory>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// A TriangleSoup or an IndexedMesh: immutable, shared, cheap to copy. Functions that accept both kinds take
/// a Mesh. The coordinates of a Mesh are finite, and its indices refer to existing vertices.
///
/// Vertices with equal coordinates are the same vertex, in either kind. An indexed mesh may therefore repeat
/// vertices, as in files whose faces share none; slicing, welding and inspection treat them as one vertex.
class Mesh {
  public:
    /// An empty soup.
    Mesh() = default;
    Mesh(TriangleSoup soup); // NOLINT(google-explicit-constructor): a soup is a mesh
    /// Throws the errors of `check`.
    Mesh(IndexedMesh mesh); // NOLINT(google-explicit-constructor): so is this; move it in to save a copy

    /// Return the soup or the indexed mesh; null for a mesh of the other kind.
    [[nodiscard]] const TriangleSoup* soup() const noexcept { return indexed_ ? nullptr : &soup_; }
    [[nodiscard]] const IndexedMesh* indexed() const noexcept { return indexed_.get(); }

    /// Calls `body` with the soup or the indexed mesh, and returns its result.
    template <class Body>
    decltype(auto) visit(const Body& body) const {
        return indexed_ ? body(*indexed_) : body(soup_);
    }

    /// Number of triangles.
    [[nodiscard]] std::size_t size() const noexcept {
        return indexed_ ? indexed_->triangles.size() : soup_.size();
    }
    [[nodiscard]] bool empty() const noexcept { return size() == 0; }

    /// Returns the corners of triangle i, counter-clockwise seen from outside.
    [[nodiscard]] Triangle3 triangle(std::size_t i) const noexcept {
        return indexed_ ? corners(*indexed_, i) : soup_.placed(i);
    }

    /// Returns the same mesh with equal vertices joined (see `weld` of an IndexedMesh); a soup is returned as
    /// it is. The result is computed on the first call and shared by all copies of the mesh. May be called
    /// from any number of threads. Expected O(n) for the first call.
    [[nodiscard]] Mesh with_joined_vertices(const Execution& execution = {}) const;

    /// Returns the transformed mesh. If the map mirrors, triangles are flipped so that they stay
    /// counter-clockwise seen from outside. Throws Error{usage} if the map is singular or not finite, or
    /// moves an indexed mesh beyond 1e100 mm. O(1) for a soup and the identity; an indexed mesh is copied.
    [[nodiscard]] Mesh transformed(const Transform& map) const;

  private:
    struct Joined;

    TriangleSoup soup_;
    std::shared_ptr<const IndexedMesh> indexed_;
    std::shared_ptr<Joined> joined_; ///< of an indexed mesh
};

[[nodiscard]] Box3 bounding_box(const Mesh& mesh, const Execution& execution = {});
[[nodiscard]] double volume(const Mesh& mesh, const Execution& execution = {});

/// Joins all equal corners exactly; see `weld` of a TriangleSoup and of an IndexedMesh.
[[nodiscard]] IndexedMesh weld(const Mesh& mesh, const Execution& execution = {});

/// Returns all meshes as one, in this order. In the result, different meshes share no vertices. If there are
/// several meshes, each soup is welded by itself. A single mesh is returned as it is. Throws Error{limit}
/// beyond 2^32 - 1 vertices or triangles.
[[nodiscard]] Mesh joined(std::span<const Mesh> meshes, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
