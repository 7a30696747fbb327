#pragma once

// Texts of the library as Python strings.

#include "lamella/core/printable.hpp"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace lamella::python {

/// Returns a path, or a text that may contain one, as a Python string in which bytes that are not UTF-8 are
/// kept (as surrogate escapes).
[[nodiscard]] inline pybind11::str path_text(const std::string& path) {
    return pybind11::reinterpret_steal<pybind11::str>(
        PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<pybind11::ssize_t>(path.size())));
}

/// Returns warnings as the program prints them (see printable).
[[nodiscard]] inline std::vector<pybind11::str> message_texts(const std::vector<std::string>& texts) {
    std::vector<pybind11::str> printed;
    for (const std::string& text : texts)
        printed.emplace_back(printable(text));
    return printed;
}

} // namespace lamella::python
