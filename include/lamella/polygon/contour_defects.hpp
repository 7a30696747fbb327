#pragma once

// Finds the contours of a layer that are defective, one by one.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/point.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

enum class ContourDefectKind : std::uint8_t {
    open,        ///< an open chain
    crossing,    ///< crosses a contour, which may be itself
    misoriented, ///< a clockwise ring outside of material (RingKind::misoriented): it bounds no material
    tangled,     ///< bounds no material though its area is positive: it crosses itself or others, or lies
                 ///< within a misoriented ring
    overlapping, ///< a ring within material (RingKind::overlapping): of bodies that overlap, which is no
                 ///< error, or a hole with the wrong orientation
};

/// Returns "open", "crossing", "misoriented", "tangled" or "overlapping".
[[nodiscard]] std::string_view contour_defect_name(ContourDefectKind kind) noexcept;

struct ContourDefect {
    ContourDefectKind kind = ContourDefectKind::open;
    std::uint64_t contour = 0;
    std::uint64_t other =
        0;     ///< index of the contour that it crosses; for other kinds, that of the contour itself
    Point2 at; ///< the crossing, approximately, or the first point of the contour
};

struct ContourDefects {
    /// First open chains, then crossings, then rings, each in the order of the contours.
    std::vector<ContourDefect> found;
    std::uint64_t crossings = 0; ///< number of all crossings, of which only the first are listed
    /// True if the search ended at this number of crossings. Then rings were not checked.
    bool or_more = false;
};

/// Finds the defects of a layer. Lists `keep` crossings at most. Segments that cross by no more than 2^-46 of
/// the largest coordinate do not count as crossing: the rounding of cut points to doubles can cause that.
/// Rings so thin that `rounding` can invert them may have either orientation (see orientation_is_lost). Costs
/// as much as find_crossings and nesting, and stops as they do.
[[nodiscard]] ContourDefects contour_defects(const Layer& layer, const Rounding& rounding = {},
                                             std::size_t keep = 16, const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
