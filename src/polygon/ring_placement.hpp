#pragma once

// The nesting of a layer, put together ring by ring.

#include "polygon/known_nesting.hpp"
#include "polygon/left_end.hpp"
#include "polygon/ring_copies.hpp"
#include "polygon/windings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Takes rings in the order of Nesting::order and says of each what it is and what it bounds.
class RingPlacement {
  public:
    /// `turns`: what each ring adds to the windings. All arguments are to outlive the placement.
    RingPlacement(std::span<const LeftEnd> ends, const RingCopies& copies, std::span<const Windings> turns);

    /// A ring without points.
    void place_empty(std::uint32_t ring) { result_.nesting.order.push_back(ring); }
    /// A ring and its copies, one within the other. `ring` represents them, `parent` was placed before or is
    /// Nesting::none, `winding` is that just outside of their left end.
    void position(std::uint32_t ring, std::uint32_t parent, Windings winding);

    /// Of those that were placed: the ring around all copies of a ring, and the innermost one of its copies.
    [[nodiscard]] std::uint32_t outside(std::uint32_t ring) const noexcept { return outside_[ring]; }
    [[nodiscard]] std::uint32_t innermost(std::uint32_t ring) const noexcept { return innermost_[ring]; }
    [[nodiscard]] const Windings& winding(std::uint32_t ring) const noexcept { return result_.outside[ring]; }
    [[nodiscard]] const Windings& winding_inside(std::uint32_t ring) const noexcept {
        return result_.inside[ring];
    }

    /// After all rings were placed.
    [[nodiscard]] NestingWithWindings result() &&;

  private:
    /// What the bodies are of which a place within a ring has material.
    struct Inside {
        std::uint32_t body = Nesting::none; ///< the innermost one
        std::uint32_t missing = 0;          ///< how many clockwise rings are too many
    };

    void place_one(std::uint32_t ring, std::uint32_t parent, const Windings& winding, RingKind kind);
    void find_body(std::uint32_t ring, Inside& inside);
    [[nodiscard]] std::uint32_t next_copy(std::uint32_t ring, bool counter_clockwise) const noexcept;

    std::span<const LeftEnd> ends_;
    const RingCopies& copies_;
    std::span<const Windings> turns_;
    NestingWithWindings result_;
    std::vector<Inside> inside_;
    std::vector<std::uint32_t> around_;    ///< of a body: the body in which it lies
    std::vector<std::uint32_t> outside_;   ///< of a representative: the parent of the first of its copies
    std::vector<std::uint32_t> innermost_; ///< of a representative: the last of its copies
};

} // namespace lamella
