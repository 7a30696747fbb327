#pragma once

// What is left of a convex polygon around a convex hole.

#include "lamella/core/point.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Triangles, counter-clockwise, between a convex polygon and a strictly convex one inside of it, both
/// counter-clockwise, without added vertices: as many as both have corners. Corners of `outer` are numbered
/// from 0, those of `inner` after them. O(outer * inner).
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate_ring(std::span<const Point2> outer,
                                                                         std::span<const Point2> inner);

} // namespace lamella
