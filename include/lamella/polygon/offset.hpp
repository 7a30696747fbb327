#pragma once

// Compensation for the width of a beam or for what a pixel bleeds: contours moved outwards or inwards.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// What joins sides that part at a corner when they are moved.
enum class OffsetCorner : std::uint8_t {
    mitre, ///< both sides, made longer until they meet
    bevel, ///< a line from end to end
    round, ///< an arc around the corner, in chords
};

/// The name as users meet it, such as "mitre".
[[nodiscard]] std::string_view offset_corner_name(OffsetCorner corner) noexcept;

struct OffsetCorners {
    OffsetCorner shape = OffsetCorner::mitre;
    /// A mitre whose tip is farther from its corner than this many times the distance is cut off at right
    /// angles to its bisector, at the distance. At least 1. `mitre_tolerance` is allowed on top.
    double mitre_limit = 2;
    /// How far chords may be from their arc, in mm; above 0. Coordinates are rounded to some 2^-36 of the
    /// layer's extent after it has grown: chords are not finer than that.
    double arc_tolerance_mm = 0.001;

    /// A share of the limit. Corners of the same shape differ by the rounding of their coordinates, and all
    /// of them are to be mitred or none.
    static constexpr double mitre_tolerance = 1e-4;
    /// How far from its corner the tip of a mitre is at most, in distances.
    [[nodiscard]] double longest_mitre() const noexcept { return mitre_limit * (1 + mitre_tolerance); }

    friend bool operator==(const OffsetCorners&, const OffsetCorners&) = default;
};

/// The layer with its material grown by `distance` mm on all sides, or shrunk by a negative one: outer rings
/// move outwards, holes get smaller, and what meets is united, as material where the winding number is above
/// 0.
///
/// Sides are moved in parallel. Where two of them part, they are joined as `corners` say; by default they
/// meet again in corners, so that parts keep their corners, and a corner that would move by more than twice
/// the distance (sharper than 60 degrees) is cut off. Where they run into one another, they end where they
/// meet. What is grown is the material with a strip along each side and a wedge at each corner; what is
/// shrunk is the material without these: exactly, but for the rounding of coordinates where sides meet, and
/// for at most some 2^-36 of the layer's extent: in rings that come to meet themselves or others, and by
/// points of rings on the straight way between others, which are left out.
///
/// Open chains stay as they are. A distance of 0 gives the layer itself, bit for bit; other results have no
/// hatches. `vanished`, where given, becomes the number of rings that nothing is left of: those of bodies
/// that are too thin to be shrunk so far, and holes that growing closes.
///
/// Expected O(n) for n points in rings that meet nothing before and after, O((n + k) log n) for others with k
/// crossings of moved rings. Throws Error{usage} for a distance that is not finite and corners that cannot
/// be, Error{limit} as `fill` does and for more points than `limits.memory` has room for, and
/// Error{cancelled}.
[[nodiscard]] Layer offset(const Layer& layer, double distance, const OffsetCorners& corners = {},
                           std::uint64_t* vanished = nullptr, const LayerLimits& limits = {});

/// The same for several distances: the layer itself is looked at once. `vanished` is of the first of them.
[[nodiscard]] std::vector<Layer> offsets(const Layer& layer, std::span<const double> distances,
                                         const OffsetCorners& corners = {}, std::uint64_t* vanished = nullptr,
                                         const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
