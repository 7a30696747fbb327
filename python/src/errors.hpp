#pragma once

namespace lamella::python {

/// Registers the conversion of C++ exceptions that leave this module to exceptions of the package: a
/// lamella::Error to the class of lamella._errors for its kind, with the same text; std::bad_alloc to a
/// LimitError; anything else to an InternalError.
void register_errors();

} // namespace lamella::python
