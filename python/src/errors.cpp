#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "bindings.hpp"

#include <pybind11/pybind11.h>

#include <cerrno>
#include <exception>
#include <new>

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

/// Raises the exception. The text may contain paths, of which bytes that are not UTF-8 are escaped, as in the
/// program. `system_error` is the errno of the cause, or 0.
void raise(ErrorKind kind, const char* text, int system_error = 0) {
    const py::object error = py::module_::import("lamella._errors")
                                 .attr("error_of")(class_name(kind), printable(text), system_error);
    PyErr_SetObject(py::type::of(error).ptr(), error.ptr());
}

} // namespace

void register_errors() {
    // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 asks for a function of this very type
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown)
                std::rethrow_exception(thrown);
        } catch (const Error& error) {
            raise(error.kind(), error.what(), error.system_error());
        } catch (const py::error_already_set&) {
            throw;                        // an exception of Python
        } catch (const py::cast_error&) { // see made.hpp; pybind11 checks pointers itself
            PyErr_SetString(PyExc_TypeError,
                            "an object cannot be used: perhaps its __init__ has not been called");
        } catch (const py::builtin_exception&) {
            throw; // an exception of Python
        } catch (const std::bad_alloc&) {
            raise(ErrorKind::limit,
                  "memory ran out; free some, or work on less at once: fewer parts or fewer layers (layers)",
                  ENOMEM);
        } catch (const std::exception& unknown) {
            raise(ErrorKind::internal, unknown.what());
        }
    });
}

} // namespace lamella::python
