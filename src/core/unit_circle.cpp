#include "lamella/core/unit_circle.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace lamella {

namespace {

/// Sums the Taylor series for 0 <= angle <= pi / 4, where the first omitted term is below 2^-60.
CosSin first_octant(double angle) noexcept {
    const double q = angle * angle;
    double cosine = 0;
    double sine = 0;
    for (int k = 18; k >= 2; k -= 2) {
        cosine = (1 - cosine) * q / (k * (k - 1));
        sine = (1 - sine) * q / (k * (k + 1));
    }
    return {1 - cosine, angle - angle * sine};
}

/// Maps cosine and sine from the first octant to the given octant. In odd octants they must be those of the
/// angle from the point to the end of the octant.
CosSin in_octant(unsigned octant, CosSin v) noexcept {
    if (octant % 4 == 1 || octant % 4 == 2)
        std::swap(v.cos, v.sin);
    if (octant >= 2 && octant < 6)
        v.cos = 0.0 - v.cos;
    if (octant >= 4)
        v.sin = 0.0 - v.sin;
    return v;
}

} // namespace

CosSin cos_sin_turn(std::uint64_t i, std::uint64_t n) noexcept {
    i %= n;
    unsigned octant = 0;
    // Computes 8 i / n by long division: 8 i itself might overflow.
    std::uint64_t rest = i;
    for (int bit = 0; bit < 3; ++bit) {
        const bool over = rest >= n - rest;
        rest = over ? rest - (n - rest) : rest + rest;
        octant = 2 * octant + (over ? 1 : 0);
    }
    if (octant % 2 != 0) {
        if (rest == 0)
            return in_octant(octant, {std::sqrt(0.5), std::sqrt(0.5)});
        rest = n - rest;
    }
    const double part = static_cast<double>(rest) / static_cast<double>(n);
    return in_octant(octant, first_octant(part * (std::numbers::pi / 4)));
}

CosSin cos_sin_degrees(double degrees) noexcept {
    const double rotated = std::fmod(std::fabs(degrees), 360.0); // exact, and so is the subtraction below
    const auto octant = static_cast<unsigned>(rotated / 45);
    double rest = rotated - 45 * octant;
    if (octant % 2 != 0)
        rest = 45 - rest;
    CosSin v = in_octant(octant, first_octant(rest * (std::numbers::pi / 180)));
    if (degrees < 0)
        v.sin = 0.0 - v.sin;
    return v;
}

} // namespace lamella
