#pragma once

// Parses decimal numbers independently of the locale.

namespace lamella {

/// Parses the number that begins at `from`, correctly rounded: an optional minus sign, then digits with or
/// without a point and an exponent, or "inf" or "nan". Overflow gives infinity, underflow 0. Returns the end
/// of the number, or `from` if there is no number.
const char* parse_number(const char* from, const char* end, double& value) noexcept;
const char* parse_number(const char* from, const char* end, float& value) noexcept;

} // namespace lamella
