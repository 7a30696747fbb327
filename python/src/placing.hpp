#pragma once

// Boxes and transforms as Python objects: arrays of numbers.

#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"

#include <pybind11/numpy.h>

#include <array>

namespace lamella::python {

using Bounds = std::array<std::array<double, 3>, 2>;
using Matrix = std::array<std::array<double, 4>, 4>; ///< by rows; acts on columns (x, y, z, 1)

[[nodiscard]] pybind11::array_t<double> bounds_of(const Box3& box);
[[nodiscard]] Box3 box_of(const Bounds& bounds);
[[nodiscard]] bool finite(const Box3& box) noexcept;

[[nodiscard]] pybind11::array_t<double> matrix_of(const Transform& map);
/// Returns the transform. Throws Error{usage} that names the argument if the last row is not 0, 0, 0, 1.
[[nodiscard]] Transform transform_of(const Matrix& rows, const char* argument = "transform");

} // namespace lamella::python
