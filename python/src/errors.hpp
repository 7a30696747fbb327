#pragma once

namespace lamella::python {

/// Makes every exception of C++ that leaves this module one of the package: of a lamella::Error the class of
/// lamella._errors that belongs to its kind, with the same text; a LimitError where memory ran out; an
/// InternalError of anything else.
void register_errors();

} // namespace lamella::python
