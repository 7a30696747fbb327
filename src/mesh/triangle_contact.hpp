#pragma once

// What two triangles of a mesh have in common beyond the vertices that they share: decided exactly.

#include "lamella/core/point.hpp"
#include "lamella/mesh/self_intersections.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/orientation.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace lamella {

/// A triangle with the names of its corners: corners of equal name are one vertex.
struct NamedTriangle {
    Triangle3 corners;
    std::array<std::uint32_t, 3> names;
};

/// Its corners lie on a line (or in a point).
[[nodiscard]] bool flat(const Triangle3& t) noexcept;

/// None where they have nothing in common but vertices, or an edge. Neither triangle is flat. Symmetric, and
/// the same whichever way round they run. Exact for all finite coordinates.
///
/// Triangles in different planes follow Guigue and Devillers (2003): with the corner that is alone on its
/// side of the other's plane first, each triangle meets the line of both planes in an interval whose ends are
/// compared by the orientation of four corners.
[[nodiscard]] std::optional<MeetingKind> contact(const NamedTriangle& p, const NamedTriangle& q) noexcept;

/// A triangle that is compared with many others.
class ContactSeeker {
  public:
    explicit ContactSeeker(const NamedTriangle& t) noexcept
        : triangle_(t), plane_(t.corners[0], t.corners[1], t.corners[2]) {}

    /// contact(t, other), sooner: mostly all of `other` lies on one side.
    [[nodiscard]] std::optional<MeetingKind> with(const NamedTriangle& other) const noexcept {
        const int side = plane_.likely_side(other.corners[0]);
        if (side != 0 && side == plane_.likely_side(other.corners[1]) &&
            side == plane_.likely_side(other.corners[2]))
            return std::nullopt;
        return contact(triangle_, other);
    }

  private:
    NamedTriangle triangle_;
    Plane plane_;
};

/// About where: the middle of what triangles that cross have in common, or of the part of their boxes in
/// common.
[[nodiscard]] Point3 contact_place(const Triangle3& p, const Triangle3& q, MeetingKind kind) noexcept;

} // namespace lamella
