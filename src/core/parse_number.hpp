#pragma once

// Decimal numbers of texts, whatever the locale.

namespace lamella {

/// Reads the number that begins at `from`, correctly rounded: digits with or without a point and an exponent,
/// a minus sign before them, also "inf" and "nan". What is too large becomes infinite, what is too small 0.
/// Returns where the number ends; `from` where none begins.
const char* parse_number(const char* from, const char* end, double& value) noexcept;
const char* parse_number(const char* from, const char* end, float& value) noexcept;

} // namespace lamella
