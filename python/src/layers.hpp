#pragma once

#include "lamella/polygon/fill.hpp"

#include "made.hpp"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace lamella::python {

/// Returns a path, or a text that may contain one, as a Python string in which bytes that are not UTF-8 are
/// kept (as surrogate escapes).
[[nodiscard]] pybind11::str path_text(const std::string& path);
/// Returns warnings as the program prints them (see printable).
[[nodiscard]] pybind11::list message_texts(const std::vector<std::string>& texts);

/// Returns the rule of this name, which is one of the four.
[[nodiscard]] FillRule fill_rule(const std::string& name);

/// Binds the classes Layer and Stack.
void bind_layers(pybind11::module_& module);

} // namespace lamella::python
