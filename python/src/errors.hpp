#pragma once

namespace lamella::python {

/// Converts every C++ exception that leaves this module to one of the package: a lamella::Error to the class
/// of lamella._errors for its kind, with the same text; std::bad_alloc to a LimitError; anything else to an
/// InternalError.
void register_errors();

} // namespace lamella::python
