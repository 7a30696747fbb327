#pragma once

// Triangulation of a polygon that every vertical line intersects in at most one segment: exact, in linear
// time, without added vertices (Garey, Johnson, Preparata, Tarjan 1978).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// A corner on an integer grid, below 2^30 in absolute value so that every test is exact.
struct NamedPoint {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::uint32_t id = 0; ///< the caller's name for it

    friend bool operator==(const NamedPoint&, const NamedPoint&) = default;
};

/// Returns the triangles by id, counter-clockwise, of the polygon between two chains of strictly ascending x.
/// If both chains start (or end) at the same corner, both list it; otherwise the polygon has an edge there.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>>
triangulate_monotone(std::span<const NamedPoint> lower, std::span<const NamedPoint> upper);

} // namespace lamella
