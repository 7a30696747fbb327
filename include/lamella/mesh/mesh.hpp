#pragma once

// A mesh of either kind, as files hold them.

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

/// A TriangleSoup or an IndexedMesh: immutable, shared, cheap to copy. It is what all functions take that do
/// not care which of the two it is. Its coordinates are finite, and its indices those of vertices.
///
/// Vertices with equal coordinates are the same vertex, in either kind: an indexed mesh may repeat them, as
/// files do whose faces share none, and is sliced, welded and inspected as if it did not.
class Mesh {
  public:
    /// An empty soup.
    Mesh() = default;
    Mesh(TriangleSoup soup); // NOLINT(google-explicit-constructor): a soup is a mesh
    /// Throws Error{input} that names the first triangle with a vertex that is not there, or the first vertex
    /// that is not finite or too far away (see `check`).
    Mesh(IndexedMesh mesh); // NOLINT(google-explicit-constructor): so is this; move it in to save a copy

    /// What it is; the other one is null.
    [[nodiscard]] const TriangleSoup* soup() const noexcept { return indexed_ ? nullptr : &soup_; }
    [[nodiscard]] const IndexedMesh* indexed() const noexcept { return indexed_.get(); }

    /// body(soup) or body(indexed mesh).
    template <class Body>
    decltype(auto) visit(const Body& body) const {
        return indexed_ ? body(*indexed_) : body(soup_);
    }

    /// How many triangles.
    [[nodiscard]] std::size_t size() const noexcept {
        return indexed_ ? indexed_->triangles.size() : soup_.size();
    }
    [[nodiscard]] bool empty() const noexcept { return size() == 0; }

    /// The corners of triangle i, counter-clockwise seen from outside.
    [[nodiscard]] Triangle3 triangle(std::size_t i) const noexcept {
        return indexed_ ? corners(*indexed_, i) : soup_.placed(i);
    }

    /// The same mesh with each vertex once (see `weld` of an IndexedMesh); a soup as it is. Found when it is
    /// asked for the first time, and then shared by all copies of the mesh, as long as one of them lives.
    /// Expected O(n) the first time. From any number of threads.
    [[nodiscard]] Mesh with_joined_vertices(const Execution& execution = {}) const;

    /// The same mesh under a map, still counter-clockwise seen from outside when that mirrors. O(1) for a
    /// soup and for the identity; an indexed mesh is copied. Throws Error{usage} when the map is not finite,
    /// or moves vertices of an indexed mesh beyond 1e100 mm.
    [[nodiscard]] Mesh transformed(const Transform& map) const;

  private:
    struct Joined;

    TriangleSoup soup_;
    std::shared_ptr<const IndexedMesh> indexed_;
    std::shared_ptr<Joined> joined_; ///< of an indexed mesh
};

[[nodiscard]] Box3 bounding_box(const Mesh& mesh, const Execution& execution = {});
[[nodiscard]] double volume(const Mesh& mesh, const Execution& execution = {});

/// All equal corners joined, exactly; see `weld` of a TriangleSoup and of an IndexedMesh.
[[nodiscard]] IndexedMesh weld(const Mesh& mesh, const Execution& execution = {});

/// All meshes as one, in this order, sharing no vertices; a soup among several is welded by itself. One mesh
/// is passed through as it is. Throws Error{limit} beyond 2^32 - 1 vertices or triangles.
[[nodiscard]] Mesh joined(std::span<const Mesh> meshes, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
