#pragma once

#include <pybind11/pybind11.h>

namespace lamella::python {

/// Binds plans, slicing into a stack, the class LayerStream, and the engines.
void bind_slicing(pybind11::module_& module);

} // namespace lamella::python
