#pragma once

namespace lamella {

/// Heights that differ by at most this are equal, in mm: heights are multiples of a decimal fraction, or
/// sums, and differ in their last digits.
inline constexpr double same_height_mm = 1e-6;

} // namespace lamella
