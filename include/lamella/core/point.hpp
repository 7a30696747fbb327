#pragma once

// Points and boxes. Lengths are in millimetres unless a function states otherwise.

#include "lamella/core/api.hpp"

#include <compare>
#include <limits>

LAMELLA_API_BEGIN
namespace lamella {

/// A point of a layer, seen looking down the build direction (x right, y up). The default order is
/// lexicographic (x, then y); it defines the normal form of contours.
struct Point2 {
    double x = 0;
    double y = 0;

    friend bool operator==(const Point2&, const Point2&) = default;
    friend auto operator<=>(const Point2&, const Point2&) = default;
};

/// A point of a mesh; z is the build direction.
struct Point3 {
    double x = 0;
    double y = 0;
    double z = 0;

    friend bool operator==(const Point3&, const Point3&) = default;
    friend auto operator<=>(const Point3&, const Point3&) = default;
};

/// An axis-parallel box. A default box is empty (min > max) and grows with `add`.
struct Box3 {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    Point3 min{infinity, infinity, infinity};
    Point3 max{-infinity, -infinity, -infinity};

    [[nodiscard]] bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }

    void add(const Point3& p) {
        min = {p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y, p.z < min.z ? p.z : min.z};
        max = {p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y, p.z > max.z ? p.z : max.z};
    }

    void add(const Box3& other) {
        if (!other.empty()) {
            add(other.min);
            add(other.max);
        }
    }

    friend bool operator==(const Box3&, const Box3&) = default;
};

} // namespace lamella
LAMELLA_API_END
