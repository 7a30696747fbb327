#pragma once

#include "made.hpp"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace lamella::python {

/// A path, or a text that may name one, as Python has it: bytes that are no UTF-8 are kept.
[[nodiscard]] pybind11::str path_text(const std::string& path);
/// Warnings as the program shows them (see printable).
[[nodiscard]] pybind11::list message_texts(const std::vector<std::string>& texts);

/// The classes Layer and Stack.
void bind_layers(pybind11::module_& module);

} // namespace lamella::python
