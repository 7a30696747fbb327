#pragma once

// The regular icosahedron on the unit sphere, a basis for round bodies.

#include "lamella/core/point.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace lamella {

[[nodiscard]] inline std::array<Point3, 12> icosahedron_corners() noexcept {
    const double s = 1 / std::sqrt(1 + std::numbers::phi * std::numbers::phi);
    const double l = std::numbers::phi * s;
    return {{{-s, l, 0},
             {s, l, 0},
             {-s, -l, 0},
             {s, -l, 0},
             {0, -s, l},
             {0, s, l},
             {0, -s, -l},
             {0, s, -l},
             {l, 0, -s},
             {l, 0, s},
             {-l, 0, -s},
             {-l, 0, s}}};
}

/// The faces, counter-clockwise seen from outside.
inline constexpr std::array<std::array<unsigned, 3>, 20> icosahedron_faces{
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

} // namespace lamella
