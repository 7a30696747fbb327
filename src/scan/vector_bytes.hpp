#pragma once

// Memory of scan vectors.

#include "lamella/contour/layer.hpp"

#include <cstdint>

namespace lamella {

/// Memory of a point of a vector and of its text in a file.
inline constexpr std::uint64_t bytes_of_vector_point = sizeof(Point2) + 40;

[[nodiscard]] inline std::uint64_t vector_bytes(const Layer& polylines, const PointArray& hatches) noexcept {
    return (polylines.points.size() + hatches.size()) * bytes_of_vector_point;
}

} // namespace lamella
