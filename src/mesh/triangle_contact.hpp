#pragma once

// Decides exactly whether two triangles of a mesh have points in common other than those of shared vertices
// and edges.

#include "lamella/core/point.hpp"
#include "lamella/mesh/self_intersections.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/orientation.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace lamella {

/// A triangle with names for its corners; corners with equal names are the same vertex.
struct NamedTriangle {
    Triangle3 corners;
    std::array<std::uint32_t, 3> names;
};

/// Returns true if the corners lie on a line (or in a point).
[[nodiscard]] bool flat(const Triangle3& t) noexcept;

/// A triangle that is to be compared with others.
class ContactSeeker {
  public:
    explicit ContactSeeker(const NamedTriangle& t) noexcept
        : triangle_(t), plane_(t.corners[0], t.corners[1], t.corners[2]) {}

    /// Returns nullopt if the triangles have nothing in common except vertices or an edge. Neither triangle
    /// may be flat. The result depends neither on the order of the two triangles nor on their orientations,
    /// and is exact for all finite coordinates.
    [[nodiscard]] std::optional<IntersectionKind> with(const NamedTriangle& other) const noexcept {
        const int side = plane_.likely_side(other.corners[0]);
        if (side != 0 && side == plane_.likely_side(other.corners[1]) &&
            side == plane_.likely_side(other.corners[2]))
            return std::nullopt; // the usual case
        return with_close_one(other);
    }

  private:
    [[nodiscard]] std::optional<IntersectionKind> with_close_one(const NamedTriangle& other) const noexcept;

    NamedTriangle triangle_;
    TrianglePlane plane_;
};

/// Compares two triangles: see ContactSeeker::with.
[[nodiscard]] inline std::optional<IntersectionKind> contact(const NamedTriangle& p,
                                                             const NamedTriangle& q) noexcept {
    return ContactSeeker(p).with(q);
}

/// Returns an approximate location: for triangles that cross, the middle of their common segment; otherwise
/// the middle of the intersection of their boxes.
[[nodiscard]] Point3 contact_point(const Triangle3& p, const Triangle3& q, IntersectionKind kind) noexcept;

} // namespace lamella
