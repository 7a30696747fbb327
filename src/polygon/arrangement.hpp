#pragma once

// Rings cut where they meet, and the winding numbers on both sides of every piece.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"
#include "polygon/clipping_grid.hpp"
#include "polygon/material.hpp"
#include "polygon/orientation.hpp"
#include "polygon/windings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// A ring, and what it adds where it runs counter-clockwise: to the windings of its inside, and to how often
/// what is left of it winds around that: 1 for a ring that is to stay, -1 for one that is to be turned round,
/// 0 for one that is to go.
struct RingWithWinding {
    std::span<const Point2> points;
    Windings turn{1, 0};
    std::int64_t left = 0;
};

/// What changes across a piece of the boundary, from below to above, or what is there.
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

/// A corner of a ring, and where that is on the grid.
struct Corner {
    Point2 position;
    Point2 point;
};

/// A piece of the boundary, on the grid, in the order of a sweep from left to right: a line that other sides
/// may come close to, or some of a ring's that no others do. All numbers are whole.
struct Side {
    Segment line; ///< from its first place to its last one
    SideCount step;
    SideCount below = {};
    bool alone = false;
    std::uint32_t first = 0; ///< its corners but for the ends, in Arrangement::corners; of a line, none
    std::uint32_t corners = 0;

    [[nodiscard]] SideCount above() const noexcept { return below + step; }
};

/// Sides that meet in their ends only.
struct Arrangement {
    std::vector<Side> sides;
    std::vector<Corner> corners;     ///< of sides but for their ends, each from left to right
    std::vector<Corner> end_corners; ///< of rings where sides end
    Windings around;                 ///< outside of all
    /// Whether rings that are left run along one another there and back, so that nothing lies between them.
    bool walls = false;
    bool crossed = false; ///< whether the rings do, before their corners are put on the grid

    [[nodiscard]] std::span<const Corner> corners_of(const Side& side) const noexcept {
        return std::span(corners).subspan(side.first, side.corners);
    }

    /// Whether the rings as they are bound the material, up to areas that rounding to the grid can make. Not
    /// known of rings of both operands.
    [[nodiscard]] bool bounded_by_all(const Material& material) const;
    /// Whether what is left of them does.
    [[nodiscard]] bool bounded_by_rest(const Material& material) const;
};

/// The rings, in any order and each starting anywhere, cut on the grid where they meet. `around`: the
/// windings outside of all of them. O(n + (m + k) log m) for n points, m sides that come close to others or
/// turn, and k crossings, as far as these are found in that.
/// Throws Error{limit} for more crossings or pieces than the budget has room for, and Error{cancelled}.
[[nodiscard]] Arrangement arranged(std::span<const RingWithWinding> rings, const Windings& around,
                                   const ClippingGrid& grid, const LayerBudget& budget = {});

} // namespace lamella
