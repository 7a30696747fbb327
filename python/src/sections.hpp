#pragma once

#include <pybind11/pybind11.h>

namespace lamella::python {

/// Binds the class PreparedMesh, which cuts single planes.
void bind_sections(pybind11::module_& module);

} // namespace lamella::python
