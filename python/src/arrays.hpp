#pragma once

// NumPy arrays that refer to memory of the library.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <utility>
#include <vector>

namespace lamella::python {

/// Returns contiguous numbers, row by row, as a read-only array of this shape, without a copy. The array
/// keeps `owner`, the owner of the memory, alive.
template <class T>
[[nodiscard]] pybind11::array_t<T> view(const T* first, std::vector<pybind11::ssize_t> shape,
                                        const pybind11::handle& owner) {
    pybind11::array_t<T> array(std::move(shape), first, owner);
    array.attr("setflags")(pybind11::arg("write") = false);
    return array;
}

/// Returns a new array with the result of `value` for each element of the range.
template <class T, class Range, class Value>
[[nodiscard]] pybind11::array_t<T> array_of(const Range& range, const Value& value) {
    pybind11::array_t<T> array(static_cast<pybind11::ssize_t>(std::size(range)));
    T* place = array.mutable_data();
    for (const auto& element : range)
        *place++ = static_cast<T>(value(element));
    return array;
}

} // namespace lamella::python
