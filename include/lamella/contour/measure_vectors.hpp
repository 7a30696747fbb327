#pragma once

// What scan vectors take: their lengths, and the time and the energy of the beam.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include <cstdint>
#include <optional>

namespace LAMELLA_API lamella {

/// What a machine does for vectors.
struct ScanFigures {
    std::uint64_t vectors = 0;
    double marked_mm = 0;
    double jumped_mm = 0;
    double build_seconds =
        0; ///< by the speeds and delays of the parameter sets alone: what accelerates is left out
    double energy_j = 0; ///< power by the time of marking

    ScanFigures& operator+=(const ScanFigures& other) noexcept;
};

/// Of vectors executed one after the other with one parameter set, from where the beam was before, and that
/// is moved to where it ends. Some files do not tell all speeds, and have 0 instead: what goes at such a
/// speed counts as if it took no time. O(vectors).
[[nodiscard]] ScanFigures measure_vectors(const Layer& vectors, const ParameterSet& parameters,
                                          std::optional<Point2>& beam);

} // namespace lamella
