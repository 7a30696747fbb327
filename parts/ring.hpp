#pragma once

// Triangulation of the ring between a convex polygon and a convex hole.

#include "lamella/core/point.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Returns the triangles, counter-clockwise, between a convex polygon and a strictly convex one inside it,
/// both counter-clockwise. No vertices are added; the number of triangles is the number of corners of both.
/// Corners of `outer` are numbered from 0, those of `inner` after them. O(outer * inner).
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate_ring(std::span<const Point2> outer,
                                                                         std::span<const Point2> inner);

} // namespace lamella
