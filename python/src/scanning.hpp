#pragma once

#include <pybind11/pybind11.h>

namespace lamella::python {

void bind_scanning(pybind11::module_& module);

} // namespace lamella::python
