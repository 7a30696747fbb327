#include "lamella/mesh/transform.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/unit_circle.hpp"

#include "mesh/singular.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lamella {

double Transform::determinant() const noexcept {
    const auto& m = linear;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool finite(const Transform& map) noexcept {
    const auto all = [](const std::array<double, 3>& v) {
        return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    };
    return all(map.linear[0]) && all(map.linear[1]) && all(map.linear[2]) && all(map.offset);
}

bool singular(const Transform& map) noexcept {
    if (!(std::abs(map.determinant()) > 0)) // also if it is too small for a number
        return true;
    // Powers of two bring the largest entry of each row near 1. This is exact, so that tiny and huge scales
    // are judged like others.
    auto m = map.linear;
    for (auto& row : m) {
        const double largest = std::max({std::abs(row[0]), std::abs(row[1]), std::abs(row[2])});
        if (!(largest > 0) || !finite(map))
            return true;
        const int exponent = std::ilogb(largest);
        for (double& entry : row)
            entry = std::scalbn(entry, -exponent);
    }
    double determinant = 0;
    double sizes = 0; // sum of the absolute values of all products
    for (std::size_t c = 0; c < 3; ++c) {
        const double forward = m[0][c] * m[1][(c + 1) % 3] * m[2][(c + 2) % 3];
        const double backward = m[0][c] * m[1][(c + 2) % 3] * m[2][(c + 1) % 3];
        determinant += forward - backward;
        sizes += std::abs(forward) + std::abs(backward);
    }
    // A bound of the error of the determinant of a product of several maps, in which each entry is rounded.
    constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
    return !(std::abs(determinant) > rounding * sizes);
}

Transform compose(const Transform& outer, const Transform& inner) noexcept {
    Transform out;
    for (int r = 0; r < 3; ++r) {
        const auto& row = outer.linear[r];
        const auto sum = [&](double x, double y, double z) {
            return row[0] * x + row[1] * y + row[2] * z;
        };
        for (int c = 0; c < 3; ++c)
            out.linear[r][c] = sum(inner.linear[0][c], inner.linear[1][c], inner.linear[2][c]);
        out.offset[r] = sum(inner.offset[0], inner.offset[1], inner.offset[2]) + outer.offset[r];
    }
    return out;
}

Transform inverse(const Transform& map) {
    const double det = map.determinant();
    if (singular(map) || !std::isfinite(det) || det == 0)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot invert a map with determinant {}: it must be finite and not flatten "
                                "the part (is a scale factor 0?)",
                                det));
    const auto& m = map.linear;
    Transform out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            // The cofactor of element (c, r); cyclic indices give the sign.
            const int r1 = (c + 1) % 3;
            const int r2 = (c + 2) % 3;
            const int c1 = (r + 1) % 3;
            const int c2 = (r + 2) % 3;
            out.linear[r][c] = (m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]) / det + 0.0;
        }
    for (int r = 0; r < 3; ++r)
        out.offset[r] = 0.0 - (out.linear[r][0] * map.offset[0] + out.linear[r][1] * map.offset[1] +
                               out.linear[r][2] * map.offset[2]);
    return out;
}

Transform translation(double x, double y, double z) noexcept {
    Transform out;
    out.offset = {x, y, z};
    return out;
}

Transform scaling(double x, double y, double z) noexcept {
    Transform out;
    out.linear = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
    return out;
}

Transform rotation(char axis, double degrees) {
    if (!std::isfinite(degrees))
        throw Error(ErrorKind::usage,
                    fmt::format("cannot rotate by {} degrees: not a finite angle", degrees));
    const auto [c, s] = cos_sin_degrees(degrees);
    Transform out;
    switch (axis) {
    case 'x':
        out.linear = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
        break;
    case 'y':
        out.linear = {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
        break;
    case 'z':
        out.linear = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
        break;
    default:
        throw Error(ErrorKind::usage, fmt::format("cannot rotate about axis '{}': expected x, y or z", axis));
    }
    return out;
}

Transform upright(const Point3& direction) {
    const double largest = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
    if (!(largest > 0) || !std::isfinite(direction.x) || !std::isfinite(direction.y) ||
        !std::isfinite(direction.z))
        throw Error(ErrorKind::usage,
                    fmt::format("cannot slice along the direction ({}, {}, {}): expected three finite "
                                "numbers, not all 0",
                                direction.x, direction.y, direction.z));
    // Division by the largest component avoids overflow and keeps a coordinate axis exact.
    double x = direction.x / largest;
    double y = direction.y / largest;
    double z = direction.z / largest;
    const double length = std::sqrt(x * x + y * y + z * z);
    x /= length;
    y /= length;
    z /= length;
    const double radius = std::sqrt(x * x + y * y);
    Transform out;
    if (radius == 0) {
        if (z < 0) // upside down: rotate by 180 degrees about x
            out.linear = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
        return out;
    }
    // The shortest rotation, about the horizontal axis perpendicular to `direction`. In Rodrigues' formula,
    // x^2 / (1 + z) is written c^2 (1 - z), which stays accurate if `direction` points almost straight down.
    const double c = x / radius;
    const double s = y / radius;
    const double lean = z > 0 ? radius * radius / (1 + z) : 1 - z;
    out.linear = {{{1 - c * c * lean, 0.0 - c * s * lean, 0.0 - x},
                   {0.0 - c * s * lean, 1 - s * s * lean, 0.0 - y},
                   {x, y, z}}};
    return out;
}

} // namespace lamella
