#pragma once

// Layers from arrays of NumPy, and back.

#include "lamella/core/error.hpp"

#include "shared_layer.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::python {

// Arguments of other types are rejected if their conversion would lose information.
using Doubles = pybind11::array_t<double, pybind11::array::c_style>;
using Numbers = pybind11::array_t<std::int64_t, pybind11::array::c_style>;

/// Makes a layer of contours in any order.
[[nodiscard]] LayerPointer layer_of_contours(const std::vector<Doubles>& rings, double z, double bottom,
                                             double top, std::uint64_t index,
                                             const std::vector<Doubles>& chains);

/// Returns views, without a copy: the points, and where contours begin and the last one ends.
[[nodiscard]] pybind11::array_t<double> view_of(std::span<const Point2> points,
                                                const pybind11::object& owner);
[[nodiscard]] pybind11::array_t<std::int64_t> offsets_of(const pybind11::object& layer);

/// Returns what is pickled of a layer, and the layer of it.
[[nodiscard]] pybind11::tuple layer_state(const pybind11::object& layer);
[[nodiscard]] LayerPointer layer_of_state(const pybind11::tuple& state);

/// Converts a list. Throws for None, which pybind11 would convert to a null pointer.
template <class Pointer>
[[nodiscard]] std::vector<Pointer> pointers_of(const pybind11::object& list) {
    auto pointers = list.cast<std::vector<Pointer>>();
    if (std::find(pointers.begin(), pointers.end(), nullptr) != pointers.end())
        throw Error(ErrorKind::input, "None is in the place of a layer or a part of what was pickled");
    return pointers;
}

} // namespace lamella::python
