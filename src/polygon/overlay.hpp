#pragma once

// Rings of one layer or of two over one another: which of them bound the material as they are, and the others
// made right.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/fill.hpp"

#include "core/layer_budget.hpp"
#include "polygon/chain_grid.hpp"
#include "polygon/contacts.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/material.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/windings.hpp"

#include <optional>
#include <vector>

namespace lamella {

/// What becomes of a ring: it stays, is turned round, goes, or other rings take its place and that of those
/// in contact with it.
enum class Fate : std::uint8_t { kept, reversed, dropped, united };

/// Whether boundaries of material that run along one another, with nothing between them, can stay.
enum class Walls : std::uint8_t {
    left,      ///< those of rings of one operand
    dissolved, ///< none
};

/// The boundary of the material, and the fates of the rings that were there.
struct Overlaid {
    Filled filled;
    std::vector<Fate> fates;
};

/// What a layer's rings have to do with one another.
class Overlay {
  public:
    /// The rings of one operand.
    explicit Overlay(const Layer& layer, const LayerLimits& limits = {})
        : Overlay(layer, std::vector<Windings>(layer.rings, {1, 0}), limits) {}
    /// `turns`: what each ring adds to the windings of its inside. The layer is to outlive the overlay.
    Overlay(const Layer& layer, std::vector<Windings> turns, const LayerLimits& limits);

    /// Whether no rings are in contact and all of them bound material of one operand, with none around it.
    [[nodiscard]] bool clean() const noexcept;
    /// The box of all rings, of which there is at least one.
    [[nodiscard]] Box2 box() const noexcept;

    /// The boundary of the material, and the open chains of the layer; see `fill`.
    [[nodiscard]] Overlaid filled(const Material& material, Walls walls = Walls::left) const;
    /// By both operands together.
    [[nodiscard]] const Nesting& nest() const noexcept { return nest_.nesting; }

  private:
    const Layer& layer_;
    LayerBudget budget_;
    std::vector<Windings> turns_;
    MonotoneChains chains_;
    std::optional<ChainGrid> grid_;
    Contacts contacts_;
    NestingWithWindings nest_;
};

/// The material of a layer (FillRule::positive), walls dissolved. A layer that is that already is passed
/// through.
[[nodiscard]] Layer united(const Layer& layer, const LayerLimits& limits = {});
/// The same for who has its overlay.
[[nodiscard]] Layer united(const Layer& layer, const Overlay& overlay);

} // namespace lamella
