#pragma once

// Cosine and sine with the same bits on every machine. Those of the C library differ in the last place
// between versions, and parts made here must be the same everywhere. Only + - * / and exact functions.

#include "lamella/core/api.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

struct CosSin {
    double cos = 1;
    double sin = 0;
};

/// Of i/n of a turn, n > 0. Within about one unit in the last place, and exactly symmetric: points that
/// mirror or rotate (by quarter turns) into one another have the same digits. Quarter turns are exact, and at
/// an eighth of a turn both are equal.
[[nodiscard]] CosSin cos_sin_turn(std::uint64_t i, std::uint64_t n) noexcept;

/// Of an angle in degrees, finite. Multiples of 90 degrees are exact.
[[nodiscard]] CosSin cos_sin_degrees(double degrees) noexcept;

} // namespace lamella
LAMELLA_API_END
