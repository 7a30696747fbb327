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

namespace lamella {

/// A TriangleSoup or an IndexedMesh: immutable, shared, cheap to copy.
class Mesh {
  public:
    /// An empty soup.
    Mesh() = default;
    explicit Mesh(TriangleSoup soup);
    explicit Mesh(IndexedMesh mesh);

    /// What it is; the other one is null.
    [[nodiscard]] const TriangleSoup* soup() const noexcept { return indexed_ ? nullptr : &soup_; }
    [[nodiscard]] const IndexedMesh* indexed() const noexcept { return indexed_.get(); }

    /// How many triangles.
    [[nodiscard]] std::size_t size() const noexcept {
        return indexed_ ? indexed_->triangles.size() : soup_.size();
    }
    [[nodiscard]] bool empty() const noexcept { return size() == 0; }

    /// The same mesh under a map, still counter-clockwise seen from outside when that mirrors. O(1) for a
    /// soup and for the identity; an indexed mesh is copied. Throws Error{usage} when the map is not finite.
    [[nodiscard]] Mesh transformed(const Transform& map) const;

  private:
    TriangleSoup soup_;
    std::shared_ptr<const IndexedMesh> indexed_;
};

[[nodiscard]] Box3 bounding_box(const Mesh& mesh, const Execution& execution = {});
[[nodiscard]] double volume(const Mesh& mesh, const Execution& execution = {});

/// All equal corners joined, exactly; see `weld` of a TriangleSoup and of an IndexedMesh.
[[nodiscard]] IndexedMesh weld(const Mesh& mesh, const Execution& execution = {});

/// All meshes as one, in this order, sharing no vertices; a soup among several is welded by itself. One mesh
/// is passed through as it is. Throws Error{limit} beyond 2^32 - 1 vertices or triangles.
[[nodiscard]] Mesh joined(std::span<const Mesh> meshes, const Execution& execution = {});

} // namespace lamella
