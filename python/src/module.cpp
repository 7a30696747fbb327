// The extension lamella._lamella. The public functions are in the package around it; see __init__.py there.

#include "lamella/core/version.hpp"

#include "errors.hpp"
#include "files.hpp"
#include "layers.hpp"
#include "run.hpp"
#include "scanning.hpp"
#include "sections.hpp"
#include "slicing.hpp"
#include "source_mesh.hpp"
#include "source_plate.hpp"

#include <pybind11/pybind11.h>

namespace py = pybind11;

PYBIND11_MODULE(_lamella, module) {
    // The stubs contain the signatures, with Python's types.
    py::options options;
    options.disable_function_signatures();

    module.attr("__version__") = lamella::version();
    // Classes are named after the package, where users find them; so are they in pickles.
    module.attr("__module__") = "lamella";
    lamella::python::register_errors();
    lamella::python::bind_meshes(module);
    lamella::python::bind_plates(module);
    lamella::python::bind_layers(module);
    lamella::python::bind_slicing(module);
    lamella::python::bind_sections(module);
    lamella::python::bind_scanning(module);
    lamella::python::bind_files(module);
    py::delattr(module, "__module__");
    py::module_::import("atexit").attr("register")(
        py::cpp_function(&lamella::python::wait_for_work_left_alone));
}
