#pragma once

// Parses decimal numbers independently of the locale.

namespace lamella {

/// Reads the correctly rounded number that begins at `from`: an optional minus sign, digits with or without a
/// point and an exponent, or "inf" or "nan". Overflow gives infinity, underflow 0. Returns its end, or `from`
/// if there is none.
const char* parse_number(const char* from, const char* end, double& value) noexcept;
const char* parse_number(const char* from, const char* end, float& value) noexcept;

} // namespace lamella
