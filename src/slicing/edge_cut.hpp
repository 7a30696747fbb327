#pragma once

// The only formula for the point where a plane cuts an edge. All implementations, scalar and vector, compute
// exactly these operations in this order, so that a cut point has the same bits everywhere.

#include "lamella/core/point.hpp"

#include <cmath>

namespace lamella {

/// An edge prepared for cutting, from its base to its far end. A plane through the base cuts the edge; a
/// plane through the far end does not. The base is the lower end under PlaneRule::section_above, and the
/// upper end under section_below.
///
///     t = min((z - z0) * inverse_dz, 1)      x = x0 + t * dx      y = y0 + t * dy
///
/// At the base t is 0 and the point equals the base bit for bit (except that -0 becomes +0, as in all
/// layers). dx is shortened by one unit in the last place if x0 + dx rounds beyond the far end; dy likewise.
/// Rounding is monotone, so no t in [0, 1] gives a point outside the edge's box. If both ends are so near to
/// the plane that inverse_dz overflows, the far end results (min(NaN, 1) is 1 in the code below). The error
/// is at most 6 units in the last place of the edge's extent (four for t, half a unit each for the extent and
/// the product, one for shortening it), plus half a unit of the result.
///
/// If the plane is no further than the snap distance from the base, or the base lies beyond the plane, t is
/// 0: the plane goes through the base.
struct EdgeCut {
    double z0, inverse_dz, x0, dx, y0, dy, snap;

    [[nodiscard]] static double shortened(double from, double to) noexcept {
        constexpr double one_less_ulp = 1.0 - 0x1p-53;
        const double d = to - from;
        const double reached = from + d;
        const bool beyond = d >= 0 ? reached > to : reached < to;
        return d * (beyond ? one_less_ulp : 1.0);
    }

    EdgeCut(const Point3& base, const Point3& far, double snap_mm = 0) noexcept
        : z0(base.z), inverse_dz(1.0 / (far.z - base.z)), x0(base.x + 0.0), dx(shortened(base.x, far.x)),
          y0(base.y + 0.0), dy(shortened(base.y, far.y)), snap(snap_mm) {}

    [[nodiscard]] Point2 at(double z) const noexcept {
        const double t = (z - z0) * inverse_dz;
        double s = t < 1.0 ? t : 1.0;
        if (snap > 0)
            s = std::abs(z - z0) > snap && s > 0 ? s : 0;
        return {x0 + s * dx, y0 + s * dy};
    }
};

} // namespace lamella
