#pragma once

// Overlays the rings of one layer or of two. Finds rings that already bound the material, and corrects the
// others.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/fill.hpp"

#include "core/layer_budget.hpp"
#include "polygon/cell_areas.hpp"
#include "polygon/chain_grid.hpp"
#include "polygon/contacts.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/material.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/windings.hpp"

#include <optional>
#include <vector>

namespace lamella {

/// The fate of a ring: it is kept, reversed, dropped, or replaced together with the rings in contact with it.
enum class Fate : std::uint8_t { kept, reversed, dropped, united };

/// Treatment of walls, where boundaries of material run along one another with nothing between them.
enum class Walls : std::uint8_t {
    left,      ///< walls of rings of one operand stay
    dissolved, ///< no walls stay
};

/// Which rings are treated together, as a group in contact.
enum class Closeness : std::uint8_t {
    contact,  ///< rings with a common point
    rounding, ///< also rings of both operands that are closer than coordinates are rounded
};

/// The boundary of the material, and the fates of the given rings.
struct Overlaid {
    Filled filled;
    std::vector<Fate> fates;
};

/// The contacts and the nesting of a layer's rings.
class Overlay {
  public:
    /// Examines the rings of one operand.
    explicit Overlay(const Layer& layer, const LayerLimits& limits = {},
                     const CrossingLimit& most = most_crossings)
        : Overlay(layer, std::vector<Windings>(layer.rings, {1, 0}), limits, most) {}
    /// `turns` is each ring's contribution to the winding numbers of its inside. The layer must outlive this
    /// object. This and `filled` throw Error{limit} for more than `most` crossings.
    Overlay(const Layer& layer, std::vector<Windings> turns, const LayerLimits& limits,
            const CrossingLimit& most = most_crossings, Closeness closeness = Closeness::contact);

    /// Returns whether no rings are in contact and every ring bounds material, so that no winding number
    /// exceeds 1.
    [[nodiscard]] bool clean() const noexcept;
    /// Returns the box of all rings. Requires at least one ring.
    [[nodiscard]] Box2 box() const noexcept;

    /// Returns the boundary of the material, with the open chains of the layer; see `fill`.
    [[nodiscard]] Overlaid filled(const Material& material, Walls walls = Walls::left) const;
    /// Returns the areas of all pairs of winding numbers; see `cell_areas`.
    [[nodiscard]] std::vector<CellArea> areas() const;
    /// Returns the nesting of the rings of both operands together.
    [[nodiscard]] const Nesting& nest() const noexcept { return nest_.nesting; }

  private:
    const Layer& layer_;
    LayerBudget budget_;
    CrossingLimit most_;
    Closeness closeness_;
    std::vector<Windings> turns_;
    MonotoneChains chains_;
    std::optional<ChainGrid> grid_;
    Contacts contacts_;
    NestingWithWindings nest_;
};

/// Returns the boundary of the material of a layer (FillRule::positive) without walls. If the layer already
/// has this form, returns it unchanged.
[[nodiscard]] Layer united(const Layer& layer, const LayerLimits& limits = {});
/// Returns the same, given the overlay of the layer.
[[nodiscard]] Layer united(const Layer& layer, const Overlay& overlay);

} // namespace lamella
