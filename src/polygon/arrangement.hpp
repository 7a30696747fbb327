#pragma once

// Rings cut at their intersections, and the winding numbers on both sides of every piece.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"
#include "polygon/clipping_grid.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/material.hpp"
#include "polygon/orientation.hpp"
#include "polygon/windings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// A ring and its contribution to the points that it encloses counter-clockwise. `turn` is added to their
/// winding numbers. `left` is added to the winding number of the remaining rings: 1 if the ring remains, -1
/// if it remains reversed, 0 if it is removed.
struct RingWithWinding {
    std::span<const Point2> points;
    Windings turn{1, 0};
    std::int64_t left = 0;
};

/// The change across a piece of the boundary from below to above, or the counts at a point.
struct SideCount {
    Windings windings;
    std::int64_t left = 0;

    SideCount& operator+=(const SideCount& other) noexcept {
        windings += other.windings;
        left += other.left;
        return *this;
    }
    friend SideCount operator*(std::int64_t times, const SideCount& c) noexcept {
        return {times * c.windings, times * c.left};
    }
    friend SideCount operator+(SideCount a, const SideCount& b) noexcept { return a += b; }
    friend bool operator==(const SideCount&, const SideCount&) = default;
};

/// A corner of a ring and its position on the grid.
struct Corner {
    Point2 position;
    Point2 point;
};

/// A piece of the boundary on the grid, from left to right: a single segment that other sides may come close
/// to, or consecutive segments of a ring that no other sides come close to. All coordinates are integers.
struct Side {
    Segment line; ///< from its first position to its last
    SideCount step;
    SideCount below = {};
    bool alone = false;
    std::uint32_t first = 0; ///< corners without the ends, in Arrangement::corners; none for a segment
    std::uint32_t corners = 0;

    [[nodiscard]] SideCount above() const noexcept { return below + step; }
};

/// Sides that meet only at their ends.
struct Arrangement {
    std::vector<Side> sides;
    std::vector<Corner> corners;     ///< of the sides without their ends, each from left to right
    std::vector<Corner> end_corners; ///< of rings, where sides end
    Windings around;                 ///< outside of all rings
    /// True if remaining rings run along one another in opposite directions, with no area between them.
    bool walls = false;
    bool crossed = false; ///< true if the rings cross before their corners are rounded to the grid

    [[nodiscard]] std::span<const Corner> corners_of(const Side& side) const noexcept {
        return std::span(corners).subspan(side.first, side.corners);
    }

    /// Returns whether the unchanged rings bound the material, up to the areas that rounding to the grid can
    /// create. Meaningless for rings of both operands.
    [[nodiscard]] bool bounded_by_all(const Material& material) const;
    /// Returns the same for the remaining rings.
    [[nodiscard]] bool bounded_by_rest(const Material& material) const;
};

/// Treatment of sides that lie on one line, except for the rounding to the grid.
enum class Bundles : std::uint8_t {
    when_many, ///< they are joined if they cross too often to be cut one by one
    always,    ///< they are joined, so that films of material between them, and slits, vanish
};

/// Cuts the rings on the grid at their intersections. The rings may come in any order and start at any point.
/// `around` holds the winding numbers outside of all rings. Throws Error{limit} for more than `most`
/// crossings and for more crossings or pieces than the budget allows, and Error{cancelled}. O(n + (m + k) log
/// m) for n points, k crossings, and m sides that come close to others or reverse in x, if these are found in
/// that time.
[[nodiscard]] Arrangement arranged(std::span<const RingWithWinding> rings, const Windings& around,
                                   const ClippingGrid& grid, const LayerBudget& budget = {},
                                   const CrossingLimit& most = most_crossings,
                                   Bundles bundles = Bundles::when_many);

} // namespace lamella
