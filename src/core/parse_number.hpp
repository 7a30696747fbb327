#pragma once

// Parses decimal numbers independently of the locale.

namespace lamella {

/// Reads the number that begins at `from`, correctly rounded: digits with or without a point and an exponent,
/// an optional minus sign, also "inf" and "nan". Overflow gives infinity, underflow 0. Returns the end of the
/// number; `from` if there is none.
const char* parse_number(const char* from, const char* end, double& value) noexcept;
const char* parse_number(const char* from, const char* end, float& value) noexcept;

} // namespace lamella
