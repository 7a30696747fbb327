#pragma once

// Access to the items of layers and stacks, as to those of a list.

#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>

namespace lamella::python {

/// Returns the position among `size` items that an index denotes; negative indices count from the end.
[[nodiscard]] inline std::size_t place_in(const pybind11::object& index, std::size_t size, const char* what) {
    if (PyIndex_Check(index.ptr()) == 0)
        throw pybind11::type_error(std::string("the number of a ") + what +
                                   ": expected a whole number, found " + Py_TYPE(index.ptr())->tp_name);
    const pybind11::ssize_t number = PyNumber_AsSsize_t(index.ptr(), PyExc_IndexError);
    if (number == -1 && PyErr_Occurred() != nullptr)
        throw pybind11::error_already_set();
    const auto count = static_cast<pybind11::ssize_t>(size);
    if (number < -count || number >= count)
        throw pybind11::index_error(what + std::string(" ") + std::to_string(number) + " of " +
                                    std::to_string(size));
    return static_cast<std::size_t>(number < 0 ? number + count : number);
}

/// Returns an iterator that calls __getitem__ until it raises IndexError.
[[nodiscard]] inline pybind11::iterator each_of(const pybind11::object& sequence) {
    return pybind11::reinterpret_steal<pybind11::iterator>(PySeqIter_New(sequence.ptr()));
}

} // namespace lamella::python
