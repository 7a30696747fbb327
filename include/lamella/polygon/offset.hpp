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

/// The join of two sides that separate at a corner when they are moved.
enum class OffsetCorner : std::uint8_t {
    mitre, ///< both sides, extended to their intersection
    bevel, ///< a line between their ends
    round, ///< an arc around the corner, in chords
};

/// Returns the name in the user interface, such as "mitre".
[[nodiscard]] std::string_view offset_corner_name(OffsetCorner corner) noexcept;

struct OffsetCorners {
    OffsetCorner shape = OffsetCorner::mitre;
    /// A mitre whose tip is farther from its corner than this many times the distance is cut off
    /// perpendicular to its bisector, at the distance. At least 1. `mitre_tolerance` is added.
    double mitre_limit = 2;
    /// Largest distance of chords from their arc, mm; above 0. At least 2^-36 of the distance is used; finer
    /// chords would be lost when coordinates are rounded.
    double arc_tolerance_mm = 0.001;

    /// Relative tolerance of the limit. Corners of the same shape differ by the rounding of their
    /// coordinates, and either all or none of them must be mitred.
    static constexpr double mitre_tolerance = 1e-4;
    /// Returns the largest distance of the tip of a mitre from its corner, as a multiple of the distance.
    [[nodiscard]] double longest_mitre() const noexcept { return mitre_limit * (1 + mitre_tolerance); }

    friend bool operator==(const OffsetCorners&, const OffsetCorners&) = default;
};

/// Returns the layer with its material grown by `distance` mm on all sides, or shrunk by a negative one.
/// Outer rings move outwards, holes get smaller, and overlapping material is united. Material is where the
/// winding number is above 0.
///
/// Each side is moved parallel to itself. Sides that separate are joined according to `corners`. By default
/// they are extended to their intersection, so that parts keep their corners, but a corner that would move by
/// more than twice the distance (sharper than 60 degrees) is cut off. Sides that run into one another end at
/// their intersection. Growing adds a strip along each side and a wedge at each corner to the material;
/// shrinking removes them. The result is exact except for the rounding of coordinates where sides meet, and
/// for errors of at most some 2^-36 of the layer's extent: in rings that come to meet themselves or others,
/// and by the removal of collinear points.
///
/// Open chains stay as they are. A distance of 0 returns the layer itself, bit for bit; other results have no
/// hatches. `vanished`, if given, becomes the number of rings of which nothing remains: those of bodies that
/// are too thin to be shrunk by the distance, and holes that growing closes.
///
/// Throws Error{usage} for a distance that is not finite and for invalid corners, Error{limit} as `fill` does
/// and for more points than `limits.memory` allows, and Error{cancelled}. Expected O(n) for n points in rings
/// that meet nothing before and after, O((n + k) log n) for others with k crossings of moved rings.
[[nodiscard]] Layer offset(const Layer& layer, double distance, const OffsetCorners& corners = {},
                           std::uint64_t* vanished = nullptr, const LayerLimits& limits = {});

/// Offsets by several distances, but examines the layer once. `vanished` is that of the first distance.
[[nodiscard]] std::vector<Layer> offsets(const Layer& layer, std::span<const double> distances,
                                         const OffsetCorners& corners = {}, std::uint64_t* vanished = nullptr,
                                         const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
