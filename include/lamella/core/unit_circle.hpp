#pragma once

// Cosine and sine with the same bits on every machine, computed with + - * / and exact functions only. The
// functions of the C library differ in the last bit between versions, but parts made here must be the same
// everywhere.

#include "lamella/core/api.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

struct CosSin {
    double cos = 1;
    double sin = 0;
};

/// Returns cosine and sine of i/n of a full turn, n > 0. They are accurate to about one unit in the last
/// place (ulp) and exactly symmetric: points that are mirror images or rotations by 90 degrees of one another
/// have the same digits. Multiples of 90 degrees are exact, and at 45 degrees both are equal.
[[nodiscard]] CosSin cos_sin_turn(std::uint64_t i, std::uint64_t n) noexcept;

/// Returns cosine and sine of a finite angle in degrees. Multiples of 90 degrees are exact.
[[nodiscard]] CosSin cos_sin_degrees(double degrees) noexcept;

} // namespace lamella
LAMELLA_API_END
