#pragma once

// Offsets contours outwards or inwards, to compensate for the width of a beam or for light bleed.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The join of two edges that separate at a corner when they are moved.
enum class OffsetCorner : std::uint8_t {
    mitre, ///< both edges, extended to their intersection
    bevel, ///< a straight line between their ends
    round, ///< an arc around the corner, in chords
};

/// Returns the name in the user interface, such as "mitre".
[[nodiscard]] std::string_view offset_corner_name(OffsetCorner corner) noexcept;

struct OffsetCorners {
    OffsetCorner shape = OffsetCorner::mitre;
    /// A mitre whose tip would be farther from the corner than mitre_limit (1 + mitre_tolerance) times the
    /// offset distance is cut off, perpendicular to its bisector, at the offset distance from the corner.
    /// mitre_limit must be at least 1.
    double mitre_limit = 2;
    /// Largest distance of chords from their arc, mm; above 0. A value below 2^-36 of the offset distance has
    /// the effect of that bound, because rounding of coordinates would hide finer chords.
    double arc_tolerance_mm = 0.001;

    /// Relative tolerance of the limit. Without this tolerance, rounded coordinates could decide which of
    /// several corners of the same shape are mitred and which are cut off.
    static constexpr double mitre_tolerance = 1e-4;
    /// Returns the largest distance of the tip of a mitre from its corner, as a multiple of the offset
    /// distance.
    [[nodiscard]] double longest_mitre() const noexcept { return mitre_limit * (1 + mitre_tolerance); }

    friend bool operator==(const OffsetCorners&, const OffsetCorners&) = default;
};

struct OffsetOptions {
    OffsetCorners corners = {};
    LayerLimits limits = {};
};

/// Returns the layer with its material grown by `distance` mm on all sides, or shrunk if `distance` is
/// negative. If it grows, outer rings move outwards, holes get smaller, and overlapping material is united.
/// Material is where the winding number is above 0.
///
/// Each edge is moved parallel to itself. Edges that separate are joined according to `options.corners`. By
/// default, edges that separate are extended to their intersection, so that parts keep their corners; a
/// corner that would move by more than twice the distance (sharper than 60 degrees) is cut off. Edges that
/// run into one another end at their intersection. Growing adds to the material a strip along each edge, and
/// a wedge at each corner where edges separate; shrinking removes them. The result is exact, with two
/// exceptions. New points are rounded to doubles. Rings that touch or cross themselves or others, before or
/// after the move, and rings whose collinear points are removed, may have errors of a few units of the grid
/// to which `fill` rounds.
///
/// Open chains stay as they are. A distance of 0 returns the layer itself, bit for bit.
///
/// Throws Error{usage} for a distance that is not finite and for invalid corners, Error{limit} as `fill` does
/// and for more points than the limits allow, and Error{cancelled}. Expected O(n) for n points in rings that
/// touch no ring before and after the move; otherwise O((n + k) log n) for k crossings of moved rings.
[[nodiscard]] Layer offset(const Layer& layer, double distance, const OffsetOptions& options = {});

/// Returns the offsets by several distances, but examines the layer only once.
[[nodiscard]] std::vector<Layer> offsets(const Layer& layer, std::span<const double> distances,
                                         const OffsetOptions& options = {});

struct CountedOffset {
    Layer layer;
    /// Number of rings that vanish: rings of bodies that are too thin for a shrinking offset, and holes that
    /// a growing offset closes.
    std::uint64_t rings_vanished = 0;
};

/// Returns the offset, and counts the rings that vanish. This takes longer if rings nearly vanish.
[[nodiscard]] CountedOffset counted_offset(const Layer& layer, double distance,
                                           const OffsetOptions& options = {});

} // namespace lamella
LAMELLA_API_END
