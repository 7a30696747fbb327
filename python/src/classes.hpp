#pragma once

// Parts that classes of the extension have in common: construction, pickling, and methods in Python.

#include "lamella/core/error.hpp"

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace lamella::python {

/// Returns a setup that gives public classes a `__new__` of their own. Without it, pickle protocols before 2
/// and `__reduce__` would make an object of pybind11's base class, which ends the process. With it they raise
/// a TypeError.
inline pybind11::custom_type_setup own_new() {
    return pybind11::custom_type_setup([](PyHeapTypeObject* heap_type) {
        heap_type->ht_type.tp_new = [](PyTypeObject* type, PyObject* /*arguments*/, PyObject* /*named*/) {
            return pybind11::detail::make_new_instance(type);
        };
    });
}

/// Gives a class the methods that a module of the package has for it: those that take keywords and check
/// their arguments. The constructor that is bound already becomes `_make`.
inline void complete(const pybind11::handle& cls, const char* methods) {
    pybind11::module_::import((std::string("lamella.") + methods).c_str()).attr("complete")(cls);
}

/// Makes objects picklable and copyable as a tuple of `size` items. `get(object)` returns the tuple.
/// `set(tuple)` makes an object of the tuple, whose content it must check, because it may come from anywhere.
template <class Class, class Get, class Set>
void bind_pickle(Class& cls, const char* what, std::size_t size, const Get& get, const Set& set) {
    const auto checked = [=](const pybind11::tuple& state) {
        try {
            if (state.size() == size)
                return set(state);
        } catch (const pybind11::cast_error&) {              // an item of another type
        } catch (const pybind11::error_already_set& error) { // an array of another type
            if (!error.matches(PyExc_TypeError))
                throw;
        }
        throw Error(ErrorKind::input, std::string("this is no pickled ") + what);
    };
    cls.def(pybind11::pickle(get, checked));
    // Older protocols do not call __getstate__.
    cls.def("__reduce_ex__", [](const pybind11::object& self, int protocol) {
        const pybind11::object plain = pybind11::module_::import("builtins").attr("object");
        return pybind11::object(plain.attr("__reduce_ex__")(self, std::max(protocol, 2)));
    });
}

} // namespace lamella::python
