// The extension lamella._lamella. The public functions are in the package around it; see __init__.py there.

#include "lamella/core/version.hpp"

#include "bindings.hpp"
#include "run.hpp"

#include <pybind11/pybind11.h>

namespace py = pybind11;

PYBIND11_MODULE(_lamella, module) {
    module.attr("__version__") = lamella::version();
    // Classes are named after the package, where users find them; so are they in pickles.
    module.attr("__module__") = "lamella";
    lamella::python::register_errors();
    lamella::python::bind_meshes(module);
    lamella::python::bind_plates(module);
    lamella::python::bind_layers(module);
    lamella::python::bind_stacks(module);
    lamella::python::bind_voxels(module);
    lamella::python::bind_slicing(module);
    lamella::python::bind_sections(module);
    lamella::python::bind_strategies(module);
    lamella::python::bind_scanning(module);
    lamella::python::bind_files(module);
    py::delattr(module, "__module__");
    py::module_::import("atexit").attr("register")(
        py::cpp_function(&lamella::python::wait_for_work_left_alone));
}
