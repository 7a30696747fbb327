#pragma once

#include <pybind11/pybind11.h>

namespace lamella::python {

/// Binds functions and classes that read, write, check and compare layers.
void bind_files(pybind11::module_& module);

} // namespace lamella::python
