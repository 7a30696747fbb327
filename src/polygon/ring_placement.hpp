#pragma once

// Builds the nesting of a layer ring by ring.

#include "polygon/known_nesting.hpp"
#include "polygon/left_end.hpp"
#include "polygon/ring_copies.hpp"
#include "polygon/windings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Takes rings in the order of Nesting::order and determines for each its kind and the body that it bounds.
class RingPlacement {
  public:
    /// `turns` is each ring's contribution to the winding numbers. All arguments must outlive this object.
    RingPlacement(std::span<const LeftEnd> ends, const RingCopies& copies, std::span<const Windings> turns);

    /// Places a ring without points.
    void place_empty(std::uint32_t ring) { result_.nesting.order.push_back(ring); }
    /// Places a ring and its copies, one within the other. `ring` represents them. `parent` was placed
    /// before, or is Nesting::none. `winding` has the winding numbers just outside of their left end.
    void place(std::uint32_t ring, std::uint32_t parent, Windings winding);

    /// Return the ring around all copies of a placed ring, and the innermost of its copies.
    [[nodiscard]] std::uint32_t outside(std::uint32_t ring) const noexcept { return outside_[ring]; }
    [[nodiscard]] std::uint32_t innermost(std::uint32_t ring) const noexcept { return innermost_[ring]; }
    [[nodiscard]] const Windings& winding(std::uint32_t ring) const noexcept { return result_.outside[ring]; }
    [[nodiscard]] const Windings& winding_inside(std::uint32_t ring) const noexcept {
        return result_.inside[ring];
    }

    /// Returns the result after all rings were placed.
    [[nodiscard]] NestingWithWindings result() &&;

  private:
    /// The bodies around a point within a ring.
    struct Inside {
        std::uint32_t body = Nesting::none; ///< the innermost one
        std::uint32_t missing = 0;          ///< number of clockwise rings that remove no body
    };

    void place_one(std::uint32_t ring, std::uint32_t parent, const Windings& winding, RingKind kind);
    void find_body(std::uint32_t ring, Inside& inside);
    [[nodiscard]] std::uint32_t next_copy(std::uint32_t ring, bool counter_clockwise) const noexcept;

    std::span<const LeftEnd> ends_;
    const RingCopies& copies_;
    std::span<const Windings> turns_;
    NestingWithWindings result_;
    std::vector<Inside> inside_;
    std::vector<std::uint32_t> around_;    ///< for a body: the body that contains it
    std::vector<std::uint32_t> outside_;   ///< for a representative: the parent of the first of its copies
    std::vector<std::uint32_t> innermost_; ///< for a representative: the last of its copies
};

} // namespace lamella
