#pragma once

// What scan vectors take.

#include "lamella/contour/layer.hpp"

#include <cstdint>

namespace lamella {

/// A point of a vector, and the text that it becomes in a file.
inline constexpr std::uint64_t bytes_of_vector_point = sizeof(Point2) + 40;

[[nodiscard]] inline std::uint64_t vector_bytes(const Layer& vectors) noexcept {
    return (vectors.points.size() + vectors.hatches.size()) * bytes_of_vector_point;
}

} // namespace lamella
