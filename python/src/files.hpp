#pragma once

#include <pybind11/pybind11.h>

namespace lamella::python {

/// Reading, writing, checking and comparing layers.
void bind_files(pybind11::module_& module);

} // namespace lamella::python
