#pragma once

// A plane of any direction, and the coordinates of points in relation to it.

#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"

namespace lamella {

/// The plane through a point at right angles to a normal of any length. Its frame has x and y in the plane,
/// the given point at the origin, and z along the normal.
class TiltedPlane {
  public:
    /// Throws Error{usage} unless all numbers are finite and the normal is not 0.
    TiltedPlane(const Point3& origin, const Point3& normal);

    /// Returns a point in the frame of the plane. The sign of z is that of (p - origin) . normal, exactly: z
    /// is 0 only for points in the plane that was given. x and y are rounded.
    [[nodiscard]] Point3 operator()(const Point3& p) const noexcept;

    /// Returns the map from the frame to the coordinates of the points.
    [[nodiscard]] Transform from_frame() const noexcept;

  private:
    Point3 origin_;
    Point3 normal_;
    Point3 scaled_; ///< the normal times a power of 2 so that its largest component is near 1
    double length_; ///< of `scaled_`
    Transform rotated_;
};

} // namespace lamella
