#pragma once

// Checks of arguments by the package, whose errors name the argument.

#include "shared_layer.hpp"

#include <pybind11/pybind11.h>

namespace lamella::python {

/// Returns what a function of lamella._arguments returns for the arguments.
template <class Value, class... Arguments>
[[nodiscard]] Value checked(const char* check, const Arguments&... arguments) {
    return pybind11::module_::import("lamella._arguments").attr(check)(arguments...).template cast<Value>();
}

/// Returns the layer that an argument must be.
[[nodiscard]] inline LayerPointer checked_layer(const char* name, const pybind11::handle& value,
                                                const char* expected) {
    if (!pybind11::isinstance<SharedLayer>(value))
        static_cast<void>(checked<pybind11::object>("refuse_type", name, expected, value));
    return value.cast<LayerPointer>();
}

} // namespace lamella::python
