#pragma once

namespace lamella {

/// Heights that differ by no more are one, in millimetres: they are products of a decimal fraction, or sums,
/// and differ in their last digits.
inline constexpr double same_height_mm = 1e-6;

} // namespace lamella
