#pragma once

#include "lamella/mesh/transform.hpp"

namespace lamella {

/// Returns true if the map flattens what it is applied to, or is not finite: its determinant is 0, or so
/// small that rounding of the entries alone explains it. The scale does not matter.
[[nodiscard]] bool singular(const Transform& map) noexcept;

} // namespace lamella
