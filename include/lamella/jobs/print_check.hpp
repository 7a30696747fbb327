#pragma once

// Checks whether layers can be printed one on the other: islands, overhangs, enclosed resin, peel areas.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/findings/findings.hpp"

#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct PrintCheckOptions {
    /// Material of a layer that shares no more than this area with the material of the layer below is an
    /// island, mm^2. At 0, only material that does not overlap it.
    double touch_mm2 = 0;
    /// Smallest angle between a surface that faces the plate and the plate, in degrees, at which a layer is
    /// carried by the one below: above 0, below 90. Layers may reach a thousandth farther than this angle
    /// lets them, for rounding.
    double overhang_angle = 45;
    /// Limit of the memory for crossings, offsets and unions of layers; see layer_limits.
    std::uint64_t max_memory = 0;
};

/// Throws Error{usage} for options out of their range.
void check(const PrintCheckOptions& options);

/// Connected material, or a connected space, over consecutive layers. If several areas of one layer begin a
/// region, its centre and first area are those of one of them.
struct PrintRegion {
    std::uint64_t layer = 0; ///< index of its first layer
    double bottom_mm = 0;    ///< bottom of the first layer
    double top_mm = 0;       ///< top of the last layer
    Point2 centre = {};      ///< centroid in the first layer
    double area_mm2 = 0;     ///< in the first layer
    double largest_mm2 = 0;  ///< the largest area in a layer
    double volume_mm3 = 0;   ///< sum of area times thickness
};

/// Material that begins in a layer without material below it, up to the layer below the one in which it joins
/// material that stands on the plate, or an island that began lower.
struct PrintIsland : PrintRegion {
    bool joins = false;   ///< false if it is still separate where it ends
    bool support = false; ///< true if its first layer is mostly material of parts that are supports
};

/// Space that material encloses in each of its layers, and that is not connected with the space outside
/// through layers below.
struct PrintCavity : PrintRegion {
    bool on_plate = false; ///< it begins in the lowest layer with material: the plate closes it
    bool opens = false;    ///< it joins the space outside in the layer above its last, or above all layers

    /// A trap never opens, and the plate does not close it: resin in it stays there. Other cavities are cups.
    /// While either is printed, the film closes it, and lifting the plate makes a vacuum in it.
    [[nodiscard]] bool trap() const noexcept { return !opens && !on_plate; }
};

/// Areas of a layer, on which forces on the printed part depend.
struct PeelArea {
    std::uint64_t index = 0;
    double bottom_mm = 0;
    double top_mm = 0;
    double area_mm2 = 0;
    double largest_mm2 = 0; ///< the largest connected area
    double perimeter_mm = 0;
    double exposed_mm2 = 0;  ///< area without material in the layer below; all of the first layer
    double overhang_mm2 = 0; ///< area farther from the material below than the angle allows, without islands
    double overhang_mm = 0;  ///< largest distance of a point in it from the material below
    std::uint64_t open_chains = 0; ///< contours that are left out, because they are not closed
};

struct PrintCheck {
    std::vector<PrintIsland> islands;  ///< by ascending layer
    std::vector<PrintCavity> cavities; ///< by ascending layer
    std::vector<PeelArea> layers;
    /// Findings of FindingOrigin::print.
    Findings findings;
};

/// Checks the material of all parts together, layer by layer, where each layer is what the source has: exact
/// contours, or the outlines of pixels. Material is where the winding number is above 0: inverted bodies are
/// none. Parts that are supports carry others. The lowest layer with material stands on the plate. Holds a
/// layer and the one below it for each thread, and the cells of one layer. Parallel over planes, with the
/// same result for any number of threads. Expected O(n log n) for n points. Throws Error{usage} for wrong
/// options, the errors of `overlaps` and `offset`, and those of PlaneSource::run.
[[nodiscard]] PrintCheck check_print(const PlaneSource& source, const PrintCheckOptions& options = {},
                                     const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
