#pragma once

namespace lamella::python {

/// Makes every lamella::Error that leaves this module an exception of the package: the class of
/// lamella._errors that belongs to its kind, with the same text.
void register_errors();

} // namespace lamella::python
