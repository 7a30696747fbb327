#include "errors.hpp"

#include "lamella/core/error.hpp"

#include <pybind11/pybind11.h>

#include <cstring>
#include <exception>

namespace py = pybind11;

namespace lamella::python {
namespace {

const char* class_name(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::internal:
        return "InternalError";
    case ErrorKind::usage:
        return "UsageError";
    case ErrorKind::input:
        return "InputError";
    case ErrorKind::defect:
        return "DefectError";
    case ErrorKind::limit:
        return "LimitError";
    case ErrorKind::output:
        return "OutputError";
    case ErrorKind::cancelled:
        return "CancelledError";
    }
    return "InternalError";
}

/// Texts name paths, and paths are bytes: those that are no UTF-8 are kept as Python keeps them.
py::object text_of(const Error& error) {
    const char* text = error.what();
    return py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(text, static_cast<py::ssize_t>(std::strlen(text)), "surrogateescape"));
}

} // namespace

void register_errors() {
    // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 asks for a function of this very type
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown)
                std::rethrow_exception(thrown);
        } catch (const Error& error) {
            const py::object type = py::module_::import("lamella._errors").attr(class_name(error.kind()));
            PyErr_SetObject(type.ptr(), text_of(error).ptr());
        }
    });
}

} // namespace lamella::python
