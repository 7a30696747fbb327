#pragma once

// What two triangles of a mesh have in common beyond the vertices that they share: decided exactly.

#include "lamella/core/point.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/orientation.hpp"

#include <array>
#include <cstdint>

namespace lamella {

enum class Contact {
    none,        ///< nothing but common vertices, or a common edge
    touching,    ///< points or a segment, and one of them goes on on one side of the other only
    crossing,    ///< a segment in which each passes through the other
    overlapping, ///< a piece of area: they lie in one plane
};

/// A triangle with the names of its corners: corners of equal name are one vertex.
struct NamedTriangle {
    Triangle3 corners;
    std::array<std::uint32_t, 3> names;
};

/// Its corners lie on a line (or in a point).
[[nodiscard]] bool flat(const Triangle3& t) noexcept;

/// Neither triangle is flat. Symmetric, and the same whichever way round they run. Exact for all finite
/// coordinates.
///
/// Triangles in different planes follow Guigue and Devillers (2003): with the corner that is alone on its
/// side of the other's plane first, each triangle meets the line of both planes in an interval whose ends are
/// compared by the orientation of four corners.
[[nodiscard]] Contact contact(const NamedTriangle& p, const NamedTriangle& q) noexcept;

/// A triangle that is compared with many others.
class ContactSeeker {
  public:
    explicit ContactSeeker(const NamedTriangle& t) noexcept
        : triangle_(t), plane_(t.corners[0], t.corners[1], t.corners[2]) {}

    /// contact(t, other), sooner: mostly all of `other` lies on one side.
    [[nodiscard]] Contact with(const NamedTriangle& other) const noexcept {
        const int side = plane_.likely_side(other.corners[0]);
        if (side != 0 && side == plane_.likely_side(other.corners[1]) &&
            side == plane_.likely_side(other.corners[2]))
            return Contact::none;
        return contact(triangle_, other);
    }

  private:
    NamedTriangle triangle_;
    Plane plane_;
};

/// About where: the middle of what triangles that cross have in common, or of the part of their boxes in
/// common.
[[nodiscard]] Point3 contact_place(const Triangle3& p, const Triangle3& q, Contact contact) noexcept;

} // namespace lamella
