#pragma once

// Measures the material that no vector reaches.

#include "lamella/contour/layer.hpp"
#include "lamella/core/unit_circle.hpp"

#include "core/layer_budget.hpp"
#include "scan/reached.hpp"

#include <functional>

namespace lamella {

/// The parallel lines along which areas are measured: at multiples of a distance from the origin. The angle
/// is oblique to most sides and vectors, because strips along the lines would be measured badly.
struct MeasuringLines {
    MeasuringLines(const Layer& material, const Reached& reached, double least_reach);

    CosSin angle;
    double distance;
};

/// Material that is wide enough for the hatch, where small unreached spots do not count.
struct WideMaterial {
    std::function<Layer()> points =
        {};                  ///< called only if more than `accepted_mm2` is unreached; may be empty
    double tip_mm2 = 0;      ///< largest spot that does not count
    double accepted_mm2 = 0; ///< largest area that may include spots which do not count
};

/// Returns the area of these rings that nothing reaches, mm^2: their area times the unreached share of the
/// lines across them. So it is exact if nothing or everything is reached. O(points + lines), plus for each
/// vector the lines close to it.
[[nodiscard]] double unreached_area(const Layer& area, const Reached& reached, const MeasuringLines& lines,
                                    const WideMaterial& wide = {}, const LayerBudget& budget = {});

/// Returns the unreached area for which no line is made: 1/32 of the square of the shortest reach. It is
/// small, since many such areas are not negligible.
[[nodiscard]] constexpr double negligible(double least_reach) noexcept {
    return least_reach * least_reach / 32;
}

/// Returns the bodies with an unreached area that is not negligible. The bodies include their holes; the
/// result is in normal form. Takes the time of `unreached_area`, plus a pass for each body over the vectors
/// close to any body.
[[nodiscard]] Layer bare_bodies(const Layer& area, const Reached& reached, const MeasuringLines& lines,
                                double least_reach, const LayerBudget& budget = {});

} // namespace lamella
