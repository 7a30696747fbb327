#pragma once

// Affine maps: position, scale and orientation of a part, and the direction in which it is sliced.

#include "lamella/core/point.hpp"

#include <array>
#include <cstddef>

LAMELLA_API_BEGIN
namespace lamella {

/// p' = linear * p + offset, in double. The default is the identity. `linear` is row-major: linear[r][c].
struct Transform {
    std::array<std::array<double, 3>, 3> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::array<double, 3> offset{0, 0, 0};

    [[nodiscard]] Point3 operator()(const Point3& p) const noexcept {
        const auto row = [&](std::size_t r) {
            return linear[r][0] * p.x + linear[r][1] * p.y + linear[r][2] * p.z + offset[r];
        };
        // Adding zero keeps -0, which would not weld to +0, out of the mesh.
        return {row(0) + 0.0, row(1) + 0.0, row(2) + 0.0};
    }

    /// Returns the determinant, which is negative if the map mirrors.
    [[nodiscard]] double determinant() const noexcept;

    friend bool operator==(const Transform&, const Transform&) = default;
};

/// Returns true if no entry is infinite or NaN.
[[nodiscard]] bool finite(const Transform& map) noexcept;

/// Returns the map that applies `inner` first, then `outer`.
[[nodiscard]] Transform compose(const Transform& outer, const Transform& inner) noexcept;

/// Returns the inverse. Throws Error{usage} if the map is singular.
[[nodiscard]] Transform inverse(const Transform& map);

[[nodiscard]] Transform translation(double x, double y, double z) noexcept;
[[nodiscard]] Transform scaling(double x, double y, double z) noexcept;

/// Returns the right-handed rotation about a coordinate axis ('x', 'y' or 'z') by degrees. Multiples of 90
/// degrees are exact, so that horizontal faces stay horizontal. Throws Error{usage} for another axis.
[[nodiscard]] Transform rotation(char axis, double degrees);

/// Returns the rotation from `direction` (any length) to +z. Slicing the rotated mesh means slicing along
/// `direction`. Coordinate axes give exact maps. Throws Error{usage} unless the length is finite and not 0.
[[nodiscard]] Transform upright(const Point3& direction);

} // namespace lamella
LAMELLA_API_END
