#pragma once

namespace lamella {

/// Heights that differ by at most this count as equal, mm. Heights that should be equal may differ in their
/// last digits, because they are multiples or sums of decimal fractions.
inline constexpr double same_height_mm = 1e-6;

} // namespace lamella
